/* tree_tags.h: what measured trees are called by those who measured them. */
#ifndef WD_WORLD_TREE_TAGS_H
#define WD_WORLD_TREE_TAGS_H

#include <stddef.h>

/* Texts of some of many trees, by number; `{0}`: no tree has one. */
struct wd_tree_tags {
    char *text; /* one text after another, the first of them empty */
    size_t size, text_capacity;
    size_t *places; /* of each tree's text; 0: none */
    size_t count, capacity;
};

/* Copies `tag`. Each tree once. */
void wd_tree_tags_set(struct wd_tree_tags *tags, size_t tree, const char *tag);
/* "" where the tree has none; good until the next is set. */
const char *wd_tree_tags_get(const struct wd_tree_tags *tags, size_t tree);
void wd_tree_tags_finish(struct wd_tree_tags *tags);

#endif
