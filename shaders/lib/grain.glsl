/* Bark finer than its texels, for an eye at arm's length: fibres, warts and dust, and edges of plates that texels
 * leave straight. Expects `frame` and shared/tree.h. */
#include "shared/noise.h"

struct wd_grain {
    float shade; /* factor on the bark's brightness, 1 on average */
    vec2 slope;  /* of its relief, around the stem and along it */
    vec2 aside;  /* how far off the texture is looked up, in tiles */
};
const wd_grain NO_GRAIN = wd_grain(1.0, vec2(0.0), vec2(0.0));

/* Waves of 16 mm down to 2, twice as long along the stem as around it. */
const int GRAIN_LONGEST = 4, GRAIN_SHORTEST = 1;
const float GRAIN_SHADE = 0.27, GRAIN_STEEP = 0.08, GRAIN_ASIDE_M = 0.0008;
const vec2 BARK_TILE_M = vec2(WD_BARK_TILE_WIDTH_M, WD_BARK_TILE_HEIGHT_M);

wd_lattice grain_lattice(vec2 place)
{
    vec2 cell = floor(place), rest = place - cell;
    return wd_lattice(int(cell.x), int(cell.y), rest.x, rest.y);
}

/* `uv`: of bark, in tiles; `footprint_m`: what a pixel spans there. */
wd_grain bark_grain(vec2 uv, float footprint_m)
{
    wd_grain grain = NO_GRAIN;
    for (int bits = GRAIN_LONGEST; bits >= GRAIN_SHORTEST; bits--) {
        float share = wd_noise_share(footprint_m, bits);
        if (share <= 0.0)
            break; /* shorter ones neither */
        vec2 place = uv * BARK_TILE_M * vec2(1.0, 0.5) * (1000.0 / float(1 << bits));
        vec3 wave = share * wd_gradient_noise(grain_lattice(place), 40u + uint(bits));
        grain.shade += GRAIN_SHADE * wave.x;
        grain.slope += GRAIN_STEEP * wave.yz * vec2(1.0, 0.5);
        grain.aside += bits == GRAIN_LONGEST ? GRAIN_ASIDE_M * wave.zy / BARK_TILE_M : vec2(0.0);
    }
    grain.shade = max(grain.shade, 0.3);
    return grain;
}

/* Moss grows in patches of a hand's width: what is added to the share of the bark that it covers, 0 on average. */
float moss_patches(vec2 uv, float share)
{
    vec2 place_m = uv * BARK_TILE_M;
    float patches = wd_gradient_noise(grain_lattice(place_m * 11.0), 50u).x
                    + 0.5 * wd_gradient_noise(grain_lattice(place_m * 40.0), 51u).x;
    return 0.6 * patches * min(4.0 * share, 1.0);
}
