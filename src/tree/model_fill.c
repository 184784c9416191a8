/* Texels that no triangle uses take the colours of those around them, so that mips of a texture
 * whose background shows nowhere do not bleed it into leaves far away (pull and push, after Gortler
 * et al., The Lumigraph, 1996). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/memory.h"
#include "shared/hash.h"
#include "tree/import_parts.h"

static float edge(const float a[2], const float b[2], float x, float y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

/* Marks texels whose middle lies in the triangle or within about a texel of it. */
static void mark_triangle(uint8_t *used, uint32_t size, float corner[3][2])
{
    float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f}, sides[3];
    for (int i = 0; i < 3; i++) {
        const float *a = corner[i], *b = corner[(i + 1) % 3];
        sides[i] = hypotf(b[0] - a[0], b[1] - a[1]);
        for (int k = 0; k < 2; k++) {
            low[k] = fmaxf(fminf(low[k], a[k] - 1), 0);
            high[k] = fminf(fmaxf(high[k], a[k] + 1), (float)size - 1);
        }
    }
    float turn = edge(corner[0], corner[1], corner[2][0], corner[2][1]) < 0 ? -1.0f : 1.0f;
    for (int y = (int)low[1]; y <= (int)high[1]; y++) {
        for (int x = (int)low[0]; x <= (int)high[0]; x++) {
            bool inside = true;
            for (int i = 0; i < 3 && inside; i++)
                inside = turn * edge(corner[i], corner[(i + 1) % 3], (float)x + 0.5f,
                                     (float)y + 0.5f) >= -sides[i];
            used[(size_t)y * size + (size_t)x] |= inside;
        }
    }
}

/* Leaves of a tree share their place on the texture: what was marked lately, by hash. */
enum { MARKED = 4096 };

static bool newly_marked(uint32_t (*marked)[3], const uint32_t uv[3])
{
    uint32_t *slot = marked[wd_hash2(wd_hash2(uv[0], uv[1]), uv[2]) % MARKED];
    if (memcmp(slot, uv, sizeof *marked) == 0)
        return false;
    memcpy(slot, uv, sizeof *marked);
    return true;
}

static void mark(uint8_t *used, uint32_t size, const struct wd_tree_mesh *mesh, uint32_t begin,
                 uint32_t end)
{
    uint32_t(*marked)[3] = wd_alloc_array(MARKED, sizeof *marked);
    for (uint32_t i = begin; i + 2 < end; i += 3) {
        float corner[3][2];
        uint32_t uv[3];
        for (uint32_t k = 0; k < 3; k++)
            uv[k] = mesh->vertices[mesh->indices[i + k]].uv;
        if (!newly_marked(marked, uv))
            continue;
        for (uint32_t k = 0; k < 3; k++) {
            wd_unpack_uv(uv[k], corner[k]);
            corner[k][0] *= (float)size;
            corner[k][1] *= (float)size;
        }
        mark_triangle(used, size, corner);
    }
    free(marked);
}

/* Fills `from` (weight in the fourth value) by way of a square of half its side. */
static void pull_push(float (*fine)[4], uint32_t size)
{
    if (size < 2)
        return;
    uint32_t half = size / 2;
    float(*coarse)[4] = wd_alloc_array((size_t)half * half, sizeof *coarse);
    for (uint32_t y = 0; y < 2 * half; y++)
        for (uint32_t x = 0; x < 2 * half; x++)
            for (int k = 0; k < 4; k++)
                coarse[(size_t)(y / 2) * half + x / 2][k] += fine[(size_t)y * size + x][k];
    pull_push(coarse, half);
    for (uint32_t y = 0; y < size; y++) {
        for (uint32_t x = 0; x < size; x++) {
            const float *from = coarse[(size_t)(y / 2 % half) * half + x / 2 % half];
            float *to = fine[(size_t)y * size + x];
            if (to[3] <= 0 && from[3] > 0)
                for (int k = 0; k < 4; k++)
                    to[k] = from[k] / from[3];
        }
    }
    free(coarse);
}

void wd_import_fill(uint8_t *rgba, uint32_t size, const struct wd_tree_mesh *mesh, uint32_t begin,
                    uint32_t end)
{
    size_t count = (size_t)size * size;
    uint8_t *used = wd_alloc(count);
    float(*colors)[4] = wd_alloc_array(count, sizeof *colors);
    mark(used, size, mesh, begin, end);
    for (size_t i = 0; i < count; i++) {
        if (!used[i])
            continue;
        for (int k = 0; k < 3; k++)
            colors[i][k] = wd_srgb_decode(rgba[4 * i + (size_t)k]);
        colors[i][3] = 1;
    }
    pull_push(colors, size);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3 && !used[i] && colors[i][3] > 0; k++)
            rgba[4 * i + k] = wd_srgb_encode(colors[i][k]);
    free(used);
    free(colors);
}
