/* sunlit.h: the sun's light that a tree standing free sends to the eye. */
#ifndef WD_TREE_SUNLIT_H
#define WD_TREE_SUNLIT_H

#include "tree/grow.h"

/* Fills model->sunlit from what of the full mesh, which has its leaves, the eye and the sun see from 21 and
 * from 32 sides: each leaf reflects or transmits by its own face and normal, as the path tracer's does. Tells
 * each of model->leaves which ways its tree leaves open, and how open it is by these (tree/leaves_open.h). Fills
 * model->sun_curve, skylit, cloud_wax, near_shade, recollision, flatness, low_sky, upper, wood_seen and stem_seen, too. To be
 * called once. */
void wd_tree_sunlit_fit(struct wd_tree_model *model);

#endif
