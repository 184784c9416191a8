/* specimen.h: what stands behind the public struct wd_specimen. */
#ifndef WD_API_SPECIMEN_H
#define WD_API_SPECIMEN_H

#include "tree/clip_mesh.h"
#include "tree/import.h"
#include "weald/tree.h"

struct wd_specimen {
    struct wd_species species; /* in its season */
    struct wd_grow_params params;
    struct wd_clip_volume clip; /* what params.clip points at */
    struct wd_clip_mesh clip_mesh; /* {0}, or what `clip` is of */
    struct wd_tree_model model;
    char *source;              /* the file that the species is from */
    double month;              /* 0: summer */
    struct wd_arena arena;
    struct wd_log log;
};

/* Reads what the specimen is to be cut to, if anything (NULL). False, logged, where it is neither a
 * box nor a mesh, or the species cannot be cut. */
bool wd_specimen_set_clip(struct wd_specimen *specimen, const char *clip);

enum { WD_SPECIMEN_LEVELS = 2 };

const struct wd_tree_mesh *wd_specimen_mesh(const struct wd_specimen *specimen, uint32_t level);

/* Where specimen `index` of a row stands, metres east of the first. */
double wd_specimen_place_m(const struct wd_specimen *const *specimens, uint32_t index);

/* Whether there is at least one, and each is there. */
bool wd_specimens_check(const struct wd_specimen *const *specimens, uint32_t count,
                        const struct wd_log *log);

#endif
