/* nearest.h: how near the camera comes to anything it sees, and how far it sees. */
#ifndef WD_FRAME_NEAREST_H
#define WD_FRAME_NEAREST_H

#include "forest/forest.h"
#include "frame/view.h"

/* A lower bound of the distance from the eye to whatever of ground and trees lies in the view, in
 * metres; large where the view holds nothing. */
float wd_nearest_seen(const struct wd_forest_device *forest, const struct wd_view *view);

/* Distance along the view axis to the farthest ground in the view, in metres, found by a few rays;
 * infinite where one of them is level or rises, or leaves the terrain. */
float wd_farthest_seen(const struct wd_terrain *terrain, const struct wd_view *view);

#endif
