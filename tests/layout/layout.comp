#version 460
/* Every struct that C and GLSL share, so that the compiled module tells its offsets. */
#include "shared/bake.h"
#include "shared/card_soup.h"
#include "shared/continuum.h"
#include "shared/crown_sky.h"
#include "shared/forest.h"
#include "shared/frame.h"
#include "shared/light.h"

layout(scalar, binding = 0) buffer Trees { wd_packed_tree tree; };
layout(scalar, binding = 1) buffer Vertices { wd_tree_vertex vertex; };
layout(scalar, binding = 2) buffer Models { wd_model model; };
layout(scalar, binding = 3) buffer Fades { wd_layer_fade fade; };
layout(scalar, binding = 4) buffer Instances { wd_instance instance; };
layout(scalar, binding = 5) buffer Pushes { wd_tree_push push; };
layout(scalar, binding = 6) buffer Frames { wd_frame_uniforms frame; };
layout(scalar, binding = 7) buffer Points { wd_tree_point point; };
layout(scalar, binding = 8) buffer Chunks { wd_card_chunk chunk; };
layout(scalar, binding = 9) buffer Cards { wd_card_flat card; };
layout(scalar, binding = 10) buffer Corners { wd_card_vertex corner; };
layout(scalar, binding = 11) buffer Planes { wd_cull_planes cull; };
layout(scalar, binding = 12) buffer SoupPushes { wd_card_soup_push soup; };
layout(scalar, binding = 13) buffer Draws { wd_draw_indexed draw; };
layout(scalar, binding = 14) buffer Leaves { wd_tree_leaf leaf; };
layout(scalar, binding = 15) buffer Sprays { wd_spray_instance spray; };
layout(scalar, binding = 16) buffer Packed { wd_packed_vertex packed; };
layout(scalar, binding = 17) buffer Forms { wd_leaf_vertex form; };
layout(scalar, binding = 18) buffer MeshPushes { wd_mesh_push mesh_push; };
layout(scalar, binding = 19) buffer SprayPushes { wd_spray_push spray_push; };
layout(scalar, binding = 20) buffer Blocks { wd_tree_block block; };
layout(scalar, binding = 21) buffer BakePushes { wd_bake_push bake; };
layout(scalar, binding = 22) buffer Crowns { wd_sky_crown crown; };
layout(scalar, binding = 23) buffer Jobs { wd_crown_sky_job job; };
layout(scalar, binding = 24) buffer SkyPushes { wd_crown_sky_push sky; };
layout(scalar, binding = 25) buffer LightPushes { wd_light_push light; };
layout(scalar, binding = 26) buffer Splats { wd_splat splat; };
layout(scalar, binding = 27) buffer SplatCorners { wd_splat_corner splat_corner; };
layout(scalar, binding = 28) buffer SplatModels { wd_splat_model splat_model; };
layout(scalar, binding = 29) buffer Clusters { wd_cluster cluster; };
layout(scalar, binding = 30) buffer SplatViews { wd_splat_view splat_view; };
layout(scalar, binding = 31) buffer SplatCounts { wd_splat_counts splat_counts; };
layout(scalar, binding = 32) buffer SplatsLost { wd_splat_lost splat_lost; };
layout(scalar, binding = 33) buffer SplatGroups { wd_splat_groups splat_groups; };
layout(scalar, binding = 34) buffer SplatTrees { wd_splat_tree splat_tree; };
layout(scalar, binding = 35) buffer LargeParts { wd_large_part large_part; };
layout(scalar, binding = 36) buffer CascadePushes { wd_cascade_push cascade_push; };
layout(scalar, binding = 37) buffer SplatItems { wd_splat_item splat_item; };

void main()
{
    tree.x_kind = block.steps + vertex.uv + point.kind + model.card_layer + uint(fade.near_begin_m)
              + instance.tree + push.level
              + frame.width + chunk.first_tree + card.turn + corner.card + uint(cull.plane[0].x)
              + soup.variants + draw.index_count + leaf.turn + spray.leaf
              + packed.xy + form.kind + mesh_push.forms + spray_push.tree.level + bake.width
              + uint(crown.foot_mm[0]) + job.slot + sky.columns + light.variants
              + splat.xy + splat_corner.tint + splat_model.wood_count + cluster.first
              + splat_view.width + splat_counts.trees + splat_lost.trees + splat_groups.select[0]
              + splat_tree.tree + large_part.id + cascade_push.layer + splat_item.tree;
}
