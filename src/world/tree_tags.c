#include "world/tree_tags.h"

#include <stdlib.h>

#include "base/memory.h"

static void put_text(struct wd_tree_tags *tags, const char *text)
{
    do
        *wd_push(tags->text, tags->size, tags->text_capacity) = *text;
    while (*text++);
}

void wd_tree_tags_set(struct wd_tree_tags *tags, size_t tree, const char *tag)
{
    if (*tag == 0)
        return;
    if (tags->size == 0)
        put_text(tags, "");
    while (tags->count <= tree)
        *wd_push(tags->places, tags->count, tags->capacity) = 0;
    tags->places[tree] = tags->size;
    put_text(tags, tag);
}

const char *wd_tree_tags_get(const struct wd_tree_tags *tags, size_t tree)
{
    return tree < tags->count ? tags->text + tags->places[tree] : "";
}

void wd_tree_tags_set_row(struct wd_tree_tags *tags, size_t tree, struct wd_tree_row row)
{
    while (tags->row_count <= tree)
        *wd_push(tags->rows, tags->row_count, tags->row_capacity) = (struct wd_tree_row){0};
    tags->rows[tree] = row;
}

struct wd_tree_row wd_tree_tags_get_row(const struct wd_tree_tags *tags, size_t tree)
{
    return tree < tags->row_count ? tags->rows[tree] : (struct wd_tree_row){0};
}

void wd_tree_tags_finish(struct wd_tree_tags *tags)
{
    free(tags->rows);
    free(tags->text);
    free(tags->places);
    *tags = (struct wd_tree_tags){0};
}
