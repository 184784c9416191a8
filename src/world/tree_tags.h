/* tree_tags.h: what measured trees are called by those who measured them, and where they say so. */
#ifndef WD_WORLD_TREE_TAGS_H
#define WD_WORLD_TREE_TAGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The row that a tree stands for. */
struct wd_tree_row {
    uint32_t inventory; /* of the scene */
    uint32_t line;      /* of its file; 0: the tree is none of a file's */
    float dbh_cm;       /* as measured; 0: it was not */
    bool crown_measured;
};

/* Texts and rows of some of many trees, by number; `{0}`: no tree has one. */
struct wd_tree_tags {
    char *text; /* one text after another, the first of them empty */
    size_t size, text_capacity;
    size_t *places; /* of each tree's text; 0: none */
    size_t count, capacity;
    struct wd_tree_row *rows;
    size_t row_count, row_capacity;
};

/* Copies `tag`. Each tree once. */
void wd_tree_tags_set(struct wd_tree_tags *tags, size_t tree, const char *tag);
/* "" where the tree has none; good until the next is set. */
const char *wd_tree_tags_get(const struct wd_tree_tags *tags, size_t tree);
void wd_tree_tags_set_row(struct wd_tree_tags *tags, size_t tree, struct wd_tree_row row);
/* Line 0 where the tree has none. */
struct wd_tree_row wd_tree_tags_get_row(const struct wd_tree_tags *tags, size_t tree);
void wd_tree_tags_finish(struct wd_tree_tags *tags);

#endif
