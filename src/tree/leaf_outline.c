#include "tree/leaf_outline.h"

#include "tree/vec.h"

static const struct wd_leaf_outline shapes[] = {
    [WD_LEAF_OVATE] = {0, {{0.72f, 0.13f}, {1, 0.40f}, {0.66f, 0.76f}}, 3, 0.14f, 0.10f,
                       WD_VEINS_PINNATE, 7, 0.20f},
    [WD_LEAF_LOBED] = {0, {{0.46f, 0.18f}, {0.70f, 0.38f}, {0.42f, 0.46f}, {1, 0.68f},
                           {0.50f, 0.78f}, {0.50f, 0.94f}}, 6, 0.12f, 0.10f,
                       WD_VEINS_PINNATE, 5, 0.22f},
    [WD_LEAF_TRIANGULAR] = {0, {{0.86f, 0.08f}, {1, 0.26f}, {0.60f, 0.60f}}, 3, 0.10f, 0.08f,
                            WD_VEINS_PINNATE, 6, 0.24f},
    [WD_LEAF_PALMATE] = {0.06f, {{0.62f, 0.02f}, {0.42f, 0.22f}, {1, 0.56f}, {0.36f, 0.54f},
                                 {0.34f, 0.78f}}, 5, 0.10f, 0.10f, WD_VEINS_PALMATE, 2, 0},
    [WD_LEAF_LANCEOLATE] = {0, {{0.8f, 0.18f}, {1, 0.42f}, {0.62f, 0.75f}}, 3, 0.20f, 0.14f,
                            WD_VEINS_PINNATE, 14, 0.10f},
    [WD_LEAF_HEART] = {0.08f, {{0.62f, 0}, {1, 0.24f}, {0.84f, 0.52f}, {0.36f, 0.82f}}, 4, 0.10f,
                       0.12f, WD_VEINS_PALMATE, 4, 0},
    [WD_LEAF_ELLIPTIC] = {0, {{0.72f, 0.16f}, {1, 0.48f}, {0.70f, 0.82f}}, 3, 0.16f, 0.08f,
                          WD_VEINS_PINNATE, 6, 0.16f},
    [WD_LEAF_BLADE] = {0, {{0.8f, 0.02f}, {1, 0.35f}, {0.62f, 0.75f}}, 3, 0.3f, 0.12f,
                       WD_VEINS_PARALLEL, 5, 0},
    [WD_LEAF_NEEDLES] = {0, {{1, 0.08f}, {0.9f, 0.75f}}, 2, 0.1f, 0.05f, WD_VEINS_PARALLEL, 1, 0},
    [WD_LEAF_SERRATE] = {0, {{0.72f, 0.13f}, {1, 0.40f}, {0.66f, 0.76f}}, 3, 0.12f, 0.10f,
                         WD_VEINS_PINNATE, 8, 0.22f},
};

/* Drawn after the figures in Stace, New Flora of the British Isles (2019): four or five lobes a side
 * of oak, birch's and brambles' double teeth as single ones, Norway maple's lobes with one tooth a side. */
static const struct wd_leaf_outline near_shapes[] = {
    [WD_LEAF_OVATE] = {0, {{0.40f, 0.05f}, {0.74f, 0.14f}, {0.95f, 0.28f}, {1, 0.42f},
                           {0.91f, 0.58f}, {0.66f, 0.76f}, {0.34f, 0.90f}, {0.10f, 0.97f}}, 8,
                       0.14f, 0.10f, WD_VEINS_PINNATE, 7, 0.20f},
    [WD_LEAF_LOBED] = {0, {{0.16f, 0.02f}, {0.22f, 0.12f}, {0.54f, 0.22f}, {0.52f, 0.30f},
                           {0.34f, 0.34f}, {0.80f, 0.45f}, {0.78f, 0.54f}, {0.46f, 0.56f},
                           {1, 0.70f}, {0.92f, 0.79f}, {0.50f, 0.78f}, {0.64f, 0.90f},
                           {0.50f, 0.955f}, {0.26f, 0.94f}}, 14, 0.12f, 0.10f,
                       WD_VEINS_PINNATE, 5, 0.22f},
    [WD_LEAF_TRIANGULAR] = {0, {{0.52f, 0.03f}, {0.92f, 0.12f}, {1, 0.25f}, {0.83f, 0.28f},
                                {0.86f, 0.39f}, {0.66f, 0.43f}, {0.66f, 0.54f}, {0.46f, 0.58f},
                                {0.43f, 0.69f}, {0.26f, 0.73f}, {0.13f, 0.88f}}, 11, 0.10f, 0.08f,
                            WD_VEINS_PINNATE, 6, 0.24f},
    [WD_LEAF_PALMATE] = {0.06f, {{0.34f, 0.01f}, {0.70f, 0.03f}, {0.58f, 0.14f}, {0.44f, 0.20f},
                                 {0.80f, 0.34f}, {1, 0.56f}, {0.74f, 0.57f}, {0.60f, 0.68f},
                                 {0.30f, 0.54f}, {0.40f, 0.74f}, {0.32f, 0.83f}, {0.12f, 0.87f}},
                         12, 0.10f, 0.10f, WD_VEINS_PALMATE, 2, 0},
    [WD_LEAF_LANCEOLATE] = {0, {{0.36f, 0.06f}, {0.80f, 0.20f}, {1, 0.40f}, {0.84f, 0.61f},
                                {0.50f, 0.80f}, {0.20f, 0.93f}}, 6, 0.20f, 0.14f,
                            WD_VEINS_PINNATE, 14, 0.10f},
    [WD_LEAF_HEART] = {0.08f, {{0.24f, 0.01f}, {0.62f, 0}, {0.90f, 0.09f}, {1, 0.24f},
                               {0.97f, 0.39f}, {0.80f, 0.55f}, {0.54f, 0.71f}, {0.26f, 0.85f},
                               {0.09f, 0.94f}}, 9, 0.10f, 0.12f, WD_VEINS_PALMATE, 4, 0},
    [WD_LEAF_ELLIPTIC] = {0, {{0.40f, 0.06f}, {0.75f, 0.18f}, {0.95f, 0.33f}, {1, 0.48f},
                              {0.93f, 0.64f}, {0.68f, 0.80f}, {0.36f, 0.91f}, {0.11f, 0.97f}}, 8,
                          0.16f, 0.08f, WD_VEINS_PINNATE, 6, 0.16f},
    [WD_LEAF_SERRATE] = {0, {{0.50f, 0.04f}, {0.82f, 0.14f}, {0.74f, 0.16f}, {1, 0.29f},
                             {0.88f, 0.31f}, {1, 0.45f}, {0.86f, 0.47f}, {0.86f, 0.60f},
                             {0.69f, 0.61f}, {0.64f, 0.74f}, {0.47f, 0.75f}, {0.37f, 0.87f},
                             {0.20f, 0.88f}}, 13, 0.12f, 0.10f, WD_VEINS_PINNATE, 8, 0.22f},
};

const struct wd_leaf_outline *wd_leaf_outline_near(const struct wd_species *species)
{
    enum wd_leaf_shape shape = species->leaf.shape;
    bool drawn = shape < sizeof near_shapes / sizeof *near_shapes && near_shapes[shape].count > 0;
    return drawn ? &near_shapes[shape] : &shapes[shape];
}

const struct wd_leaf_outline *wd_leaf_outline_of(const struct wd_species *species)
{
    return &shapes[species->leaf.shape];
}

struct wd_leaf_size wd_leaf_blade_size(const struct wd_species *species)
{
    float length_cm = species->leaf.length_cm - species->leaf.stalk_cm;
    if (species->leaf.compound != WD_COMPOUND_SIMPLE)
        return (struct wd_leaf_size){0.01f * species->leaf.leaflet_length_cm,
                                     0.01f * species->leaf.leaflet_width_cm};
    return (struct wd_leaf_size){0.01f * fmaxf(length_cm, 0.1f * species->leaf.length_cm),
                                 0.01f * species->leaf.width_cm};
}

/* Corner i of the half outline, foot and tip included. */
struct wd_vec3 wd_leaf_outline_corner(const struct wd_leaf_outline *shape, int i)
{
    if (i == 0)
        return WD_V3(0, shape->foot, 0);
    if (i > shape->count)
        return WD_V3(0, 1, 0);
    return WD_V3(shape->points[i - 1][0], shape->points[i - 1][1], 0);
}

float wd_leaf_outline_area(const struct wd_leaf_outline *shape)
{
    float twice = 0;
    for (int i = 0; i <= shape->count; i++) {
        struct wd_vec3 a = wd_leaf_outline_corner(shape, i), b = wd_leaf_outline_corner(shape, i + 1);
        twice += a.x * b.y - b.x * a.y;
    }
    return 0.5f * fabsf(twice); /* two halves of unit half width, over the width of 2 */
}

float wd_leaf_outline_widest(const struct wd_leaf_outline *shape)
{
    float widest = 0, at = 0.5f;
    for (int i = 0; i < shape->count; i++)
        if (shape->points[i][0] > widest) {
            widest = shape->points[i][0];
            at = shape->points[i][1];
        }
    return at;
}

float wd_leaf_outline_inside(const struct wd_leaf_outline *shape, float width, float x, float y)
{
    float half = 0.5f * width, nearest = 1e9f;
    struct wd_vec3 p = WD_V3(fabsf(x), y, 0);
    bool inside = false;
    for (int i = 0; i <= shape->count; i++) {
        struct wd_vec3 a = wd_leaf_outline_corner(shape, i), b = wd_leaf_outline_corner(shape, i + 1);
        a.x *= half;
        b.x *= half;
        struct wd_vec3 ab = wd_v3_sub(b, a), ap = wd_v3_sub(p, a);
        float along = wd_clampf(wd_v3_dot(ap, ab) / fmaxf(wd_v3_dot(ab, ab), 1e-12f), 0, 1);
        nearest = fminf(nearest, wd_v3_length(wd_v3_mad(ap, ab, -along)));
        if ((a.y > y) != (b.y > y) && p.x < a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
            inside = !inside;
    }
    return inside ? nearest : -nearest;
}
