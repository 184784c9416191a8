/* tree_list.h: the trees of a forest as a table. */
#ifndef WD_API_TREE_LIST_H
#define WD_API_TREE_LIST_H

#include "api/forest.h"
#include "base/log.h"

/* Writes a CSV file with a row for each tree, in the order of their ids: id as in the tree_id layer
 * of a picture, species, the trunk's foot in the terrain's own coordinates (x east, y north, z up),
 * height and crown diameter in metres, and the layer that planted it. Inventories of scenes read it
 * again. Errors: WD_ERROR_OUTPUT, WD_ERROR_INTERRUPTED; nothing is left then. */
enum wd_result wd_tree_list_write(const struct wd_forest *forest, const char *path,
                                  const struct wd_progress *progress, const struct wd_log *log);

#endif
