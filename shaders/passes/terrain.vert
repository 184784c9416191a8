#version 460
#include "shared/frame.h"
#include "shared/terrain_patch.h"

layout(scalar, set = 0, binding = 0) uniform Frame { wd_frame_uniforms frame; };
layout(scalar, set = 0, binding = 1) uniform View { wd_terrain_view view; };
layout(scalar, set = 0, binding = 2) readonly buffer Patches { wd_terrain_patch patches[]; };
layout(scalar, set = 0, binding = 3) readonly buffer Heights { float height_m[]; };

layout(location = 0) out vec3 out_rel;
layout(location = 1) out float out_curtain;

/* Where on the patch's grid a vertex lies; `hangs` is 1 at the lower end of a curtain. A curtain
 * runs along one side and falls in its first row of cells. */
ivec2 grid_place(uint edge, ivec2 vertex, out float hangs)
{
    hangs = edge == WD_EDGE_NONE ? 0.0 : min(float(vertex.y), 1.0);
    switch (edge) {
    case WD_EDGE_SOUTH: return ivec2(vertex.x, 0);
    case WD_EDGE_EAST: return ivec2(WD_PATCH_CELLS, vertex.x);
    case WD_EDGE_NORTH: return ivec2(WD_PATCH_CELLS - vertex.x, WD_PATCH_CELLS);
    case WD_EDGE_WEST: return ivec2(0, WD_PATCH_CELLS - vertex.x);
    }
    return vertex;
}

/* Equal for equal samples, whichever patch asks: nothing can come apart. */
vec3 sample_rel(ivec2 at)
{
    at = min(at, ivec2(view.width, view.height) - 1);
    ivec2 cells = at - ivec2(view.camera_cell[0], view.camera_cell[1]);
    precise vec2 across = vec2(cells) * view.cell_m - view.camera_offset_m;
    float camera_z = float(frame.camera_mm[2]) * 0.001;
    precise float up = height_m[at.y * view.width + at.x] - camera_z - frame.camera_frac_m.z;
    return vec3(across, up);
}

void main()
{
    wd_terrain_patch tile = patches[gl_InstanceIndex];
    ivec2 vertex = ivec2(gl_VertexIndex % (WD_PATCH_CELLS + 1),
                         gl_VertexIndex / (WD_PATCH_CELLS + 1));
    float hangs;
    ivec2 place = grid_place(tile.edge, vertex, hangs);
    ivec2 origin = ivec2(tile.column, tile.row);
    vec3 fine = sample_rel(origin + (place << tile.level));
    vec3 coarse = sample_rel(origin + ((place & ~1) << tile.level));
    float distance_m = length(vec3(fine.xy, view.above_m));
    vec2 morph = view.morph[tile.level];
    out_rel = mix(fine, coarse, clamp((distance_m - morph.x) * morph.y, 0.0, 1.0));
    if (hangs > 0.0)
        out_rel.z = view.curtain_m - float(frame.camera_mm[2]) * 0.001;
    out_curtain = tile.edge == WD_EDGE_NONE ? 0.0 : float(tile.edge);
    gl_Position = frame.clip_from_rel * vec4(out_rel, 1.0);
}
