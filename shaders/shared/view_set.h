/* view_set.h: pictures of a model from all over the hemisphere, and how a point gets into them.
 *
 * Every picture is orthographic and fits the upright cylinder around the model: no table of sizes
 * is needed. A model's pictures are tiles of one layer of an atlas; three images hold, at the same
 * texels (4 bytes each),
 *   albedo  RGB linear albedo (as sRGB), A coverage
 *   normal  RGB model-space normal * 0.5 + 0.5, A sky openness (ambient occlusion)
 *   depth   R front, G back: mean depth of the nearest and of the farthest surfaces, 1 at the side
 *           toward the viewer, 0 at the far side (a z-field, Bruneton and Neyret 2012);
 *           B leaves on the ray: 1 - exp(-count / 4); A share of what is seen that is leaf
 * Texels that show nothing carry their neighbours' values but no coverage. */
#ifndef WD_SHARED_VIEW_SET_H
#define WD_SHARED_VIEW_SET_H

#include "shared/hemisphere.h"

#define WD_PLANES 3
#define WD_PLANE_ALBEDO 0
#define WD_PLANE_NORMAL 1
#define WD_PLANE_DEPTH 2

/* The upright cylinder around a model, and its layer of the atlas. */
struct wd_view_model {
    float radius_m; /* about the trunk's axis */
    float bottom_m, top_m;
    uint32_t layer;
    uint32_t mixed; /* its wood over its leaves, as shared/mixed.h packs it */
};

struct wd_view_atlas {
    WD_STRUCT wd_hemisphere hemisphere;
    uint32_t size;    /* texels a side of a tile, a power of two */
    uint32_t columns; /* tiles a side of a layer */
    uint32_t mips;    /* down to tiles of 4 x 4 texels */
};

/* A picture's frame in model space: right and up in the picture, toward the viewer; half extents
 * along them about the cylinder's middle. */
struct wd_view_frame {
    WD_STRUCT wd_direction right, up, toward;
    float half_width_m, half_height_m, half_depth_m;
    float middle_m; /* height of the cylinder's middle */
};

/* Place in a picture: x right and y down, 0..1; depth as in the depth image. */
struct wd_view_point {
    float x, y, depth;
};

WD_FUNC WD_STRUCT wd_view_frame wd_view_frame_of(WD_STRUCT wd_view_model model,
                                                 WD_STRUCT wd_direction toward)
{
    WD_STRUCT wd_view_frame f;
    float level = WD_SQRT(toward.x * toward.x + toward.y * toward.y);
    float half_m = 0.5f * (model.top_m - model.bottom_m);
    f.toward = toward;
    f.right.x = level > 1e-6f ? -toward.y / level : 0.0f;
    f.right.y = level > 1e-6f ? toward.x / level : 1.0f;
    f.right.z = 0.0f;
    f.up.x = -toward.z * f.right.y;
    f.up.y = toward.z * f.right.x;
    f.up.z = level;
    f.half_width_m = model.radius_m;
    f.half_height_m = half_m * level + model.radius_m * WD_ABS(toward.z);
    f.half_depth_m = half_m * WD_ABS(toward.z) + model.radius_m * level;
    f.middle_m = 0.5f * (model.top_m + model.bottom_m);
    return f;
}

WD_FUNC WD_STRUCT wd_view_point wd_view_project(WD_STRUCT wd_view_frame f, float x_m, float y_m,
                                                float z_m)
{
    WD_STRUCT wd_view_point p;
    z_m -= f.middle_m;
    p.x = 0.5f + 0.5f * (x_m * f.right.x + y_m * f.right.y) / f.half_width_m;
    p.y = 0.5f - 0.5f * (x_m * f.up.x + y_m * f.up.y + z_m * f.up.z) / f.half_height_m;
    p.depth =
        0.5f + 0.5f * (x_m * f.toward.x + y_m * f.toward.y + z_m * f.toward.z) / f.half_depth_m;
    return p;
}

/* Place in the layer of a place in a view's tile. Filtering at mip `lod` stays within the tile. */
WD_FUNC WD_STRUCT wd_view_point wd_view_texel(WD_STRUCT wd_view_atlas atlas, uint32_t view,
                                              WD_STRUCT wd_view_point p, float lod)
{
    float edge = WD_MIN(0.5f * WD_EXP2(lod) / WD_FLOAT(atlas.size), 0.5f);
    float scale = 1.0f / WD_FLOAT(atlas.columns);
    p.x = WD_MIN(WD_MAX(p.x, edge), 1.0f - edge);
    p.y = WD_MIN(WD_MAX(p.y, edge), 1.0f - edge);
    p.x = (WD_FLOAT(view % atlas.columns) + p.x) * scale;
    p.y = (WD_FLOAT(view / atlas.columns) + p.y) * scale;
    return p;
}

#endif
