#include "tree/random.h"

static float lattice(uint32_t key, int x, int y, int z)
{
    return wd_hash_unit(wd_hash4(key, (uint32_t)x, (uint32_t)y, (uint32_t)z));
}

static float fade(float t)
{
    return t * t * (3 - 2 * t);
}

/* Without a call of the library. */
static int floor_of(float x)
{
    int whole = (int)x;
    return whole - ((float)whole > x);
}

float wd_noise3(uint32_t key, struct wd_vec3 p)
{
    int x = floor_of(p.x), y = floor_of(p.y), z = floor_of(p.z);
    float u = fade(p.x - (float)x), v = fade(p.y - (float)y), w = fade(p.z - (float)z), plane[2];
    for (int k = 0; k < 2; k++) {
        float a = wd_mixf(lattice(key, x, y, z + k), lattice(key, x + 1, y, z + k), u);
        float b = wd_mixf(lattice(key, x, y + 1, z + k), lattice(key, x + 1, y + 1, z + k), u);
        plane[k] = wd_mixf(a, b, v);
    }
    return wd_mixf(plane[0], plane[1], w);
}
