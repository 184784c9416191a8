/* Light on ground, wood and leaves. Every costly step stands here once, whatever the material:
 * software devices run both sides of a branch.
 * Expects `frame`, `push` (wd_light_push), `trees`, `lit_models`, PARTS and the libraries of noise,
 * shadow, gbuffer, tree and crown. */

const float PER_PI = 0.318309886;

#include "lib/wax.glsl"
#include "shared/turn.h"
#include "shared/wax.h"
#include "lib/skylight.glsl"
#include "lib/crown_sky.glsl"
#include "lib/haze.glsl"
#include "lib/sward.glsl"

/* --- leaves --------------------------------------------------------------------------------- */

/* acos within 0.02 (Lagarde 2014) */
float angle_of(float cosine)
{
    float x = min(abs(cosine), 1.0);
    float angle = (1.5707963 - 0.21 * x) * sqrt(1.0 - x);
    return cosine < 0.0 ? 3.14159265 - angle : angle;
}

/* Of leaves turned every way, reflected (x) and transmitted (y). */
vec2 leaf_cloud(float cosine)
{
    float angle = angle_of(cosine);
    return vec2(wd_cloud_reflects(cosine, angle), wd_cloud_transmits(cosine, angle));
}

float slenderness(wd_crown crown)
{
    return smoothstep(1.5, 3.2, crown.radii_m.z / crown.radii_m.x);
}

/* Herbs have no table of what their leaves send to an eye: those that it sees from the sun's side are those that the sun
 * reaches, the nearer both directions, the more so (Kuusk 1985). A factor on the light that an even cloud of leaves
 * would return. */
float herbs_sunlit(vec3 eye)
{
    float apart = angle_of(dot(eye, frame.sun_direction));
    float wide = mix(0.95, 0.36, smoothstep(0.0, 0.64, eye.z)), hot = mix(0.4, 2.8, smoothstep(0.2, 1.05, eye.z));
    return wide + hot * exp(-1.9 * apart);
}

#include "lib/lit_leaves.glsl"

/* Where normals spread about their mean, how far one lies along some direction varies by this, squared.
 * Of a number with mean m and variance v about (sqrt(m^2 + 2 v / pi) + m) / 2 is the mean of what is
 * above zero. */
float facing_spread(vec3 facing)
{
    return max(1.0 - dot(facing, facing), 0.0) * (1.0 / 3.0);
}

float facing_lit(vec3 facing)
{
    float mean = dot(facing, frame.sun_direction);
    return 0.5 * (sqrt(mean * mean + 0.6366 * facing_spread(facing)) + mean);
}

/* One leaf with its own normal, turned to the eye: which side the sun and the eye are on. Where the
 * normal is but the crown's (`plain` 0), leaves lie every way behind it: of those seen, the sun lights
 * the seen side of as many as both directions are apart from opposite. */
vec2 leaf_blade(vec3 facing, vec3 eye, float plain)
{
    float toward = dot(facing, eye), spread = facing_spread(facing);
    float seen = sqrt(toward * toward + 0.6366 * spread), along = dot(eye, frame.sun_direction);
    float raw = dot(facing, frame.sun_direction);
    float mean = seen * along + (raw - toward * along) * (toward / max(seen, 1e-4));
    float left = max(raw * raw + spread - mean * mean, 0.0);
    float same = 1.0 - angle_of(along) * PER_PI;
    float root = sqrt(mean * mean + 0.6366 * left);
    return 0.5 * vec2(root + mean, root - mean) * mix(vec2(same, 1.0 - same), vec2(1.0), plain);
}

/* A leaf's albedo holds what its surface reflects: what comes from within is less. Of light from everywhere wax
 * mirrors 1.6 times as much as of light along the normal, leaves of every direction pi / 8 of that to any side. Only
 * upper sides shine. What comes out through wax of the light from within is less the flatter it is looked at: 1 - WD_WAX
 * times wd_grazing. */

/* Its mean over leaves of every direction, by how much of them is seen. */
const float WAX_CLOUD = 1.0 / 21.0;

/* What a leaf's wax mirrors of the sun, relative to a lit wall: Blinn and Phong's lobe with the
 * normal reflection of wax (0.04), as wide as GGX of this roughness. Far off, leaves of every
 * direction share a pixel and the lobe widens; no leaf is flat enough for less than 0.42. */
float leaf_gloss(wd_pixel pixel, float roughness, float near)
{
    float wide = max(mix(0.8, roughness, near), 0.42);
    wide *= wide;
    float power = max(2.0 / (wide * wide) - 2.0, 1.0);
    float shine = abs(dot(pixel.normal, normalize(frame.sun_direction - pixel.direction)));
    return near * 0.04 * 0.125 * (power + 2.0) * exp2(power * log2(max(shine, 1e-3)));
}

/* What wax mirrors more of at grazing angles (Schlick 1994), where it sends light on toward an eye whose
 * angle to it has this cosine: most of what is ahead. */
float wax_ahead(float cosine)
{
    return (1.0 - WD_WAX) * wd_grazing(sqrt(max(0.5 + 0.5 * cosine, 0.0)));
}

#include "lib/place.glsl"

/* What leaves reflect from within: a measured albedo holds what the wax of upper sides mirrors, too. */
vec3 within_wax(vec3 albedo, float waxed)
{
    return albedo - waxed * min(vec3(WD_WAX), 0.75 * albedo);
}

/* Which ways past its tree a leaf has is known of one place on it and of few ways: how far that tells what its wax
 * mirrors; the rest: what leaves of such openness have, seen from there. By path-traced leaves at 512 and 1,024 px a
 * tree, 16 places each (FLIP 0.258 and 0.332 before this and WAX_OF_OWN; 0.5: 0.248 and 0.333; 0: 0.248 and 0.341). */
const float MIRRORS_KNOWN = 0.5;

float gap_toward(vec3 mirror, float openness)
{
    float layers = -0.67 * log(max(openness, 1e-2)) / max(mirror.z, 0.15);
    return smoothstep(-LOBE_SINE, LOBE_SINE, mirror.z) / (1.0 + layers);
}

/* What is mirrored of its own tree is as bright as the leaf itself about is, whose wax adds so much to its albedo. */
const float WAX_OF_OWN = 1.5 * WD_WAX;

/* Light about the mirrored ray of a single leaf. */
vec3 mirrored_by_leaf(wd_pixel pixel, wd_around around, vec3 mirror, vec3 blade, float sun_share)
{
    vec3 own = (blade + WAX_OF_OWN) * (0.5 * (around.front + around.back) + 0.2 * sunlight() * sun_share);
    float beyond = mix(gap_toward(mirror, pixel.openness), pixel.mirrors, MIRRORS_KNOWN);
    return mix(own, around.mirrored, beyond);
}

/* Of the sun that a free tree's leaves scatter to one another, where each is lit by itself: by path-traced rows of six
 * species under five suns and the gallery's hedge rows. */
const float OWN_OF_ONE_LEAF = 0.8;

/* Upright ground is where the world is cut off. */
bool is_curtain(wd_pixel pixel)
{
    return pixel.surface == 0u && abs(pixel.normal.z) < 0.01;
}

/* What is about a pixel, by which its light is summed. */
struct wd_site {
    wd_place place;
    wd_shelter shelter; /* by what stands about it, */
    wd_alone alone;     /* and by its own tree */
    vec4 facing;        /* which way it looks, and how widely (see light_around) */
    float hot;          /* factor on the sun's light on discs (see wd_sunlit_mix) */
};

bool is_leaf(wd_pixel pixel)
{
    return pixel.material >= WD_MATERIAL_LEAF;
}

/* Leaves that are lit one by one. */
bool is_single(wd_pixel pixel)
{
    return ALL_SINGLE || pixel.lit >= 0.0;
}

/* Which of its model's tables tell what of its light the eye sees. */
wd_sunlit_mix sunlit_tables(wd_pixel pixel)
{
    wd_sunlit_mix mixed = sunlit_mix(-pixel.direction);
    uint leaves = pixel.material == WD_MATERIAL_CARD ? WD_SUNLIT_CARDS : WD_SUNLIT_DEEP;
    leaves = is_single(pixel) ? WD_SUNLIT_LEAVES : leaves;
    mixed.place += (is_leaf(pixel) ? leaves : WD_SUNLIT_WOOD) * WD_SUNLIT_PLACES;
    mixed.cloud = !is_leaf(pixel) ? vec2(1.0, mixed.wood) : leaves == WD_SUNLIT_LEAVES ? vec2(1.0) : mixed.cloud;
    return mixed;
}

/* What of the sky its model's table gives it. */
vec4 skylit_by_table(wd_pixel pixel, int model_at, wd_sunlit_mix mixed, wd_crown crown)
{
    uint seen_as = pixel.lit >= 0.0 ? WD_SKYLIT_LEAVES : WD_SKYLIT_CLOUDS;
    vec4 skylit = skylit_of(model_at, mixed, is_leaf(pixel) ? seen_as : WD_SKYLIT_WOOD);
    if (is_leaf(pixel) && is_level_picture(pixel))
        skylit *= mix(vec4(1.0), open_to_eye(model_at, mixed), is_tree(crown));
    return skylit;
}

wd_site tree_site(wd_pixel pixel, uint cascade)
{
    wd_site site;
    wd_tree tree = tree_at(pixel.surface - 1u);
    uint index = WD_TREE_SPECIES(tree) * push.variants + WD_TREE_VARIANT(tree) % push.variants;
    int model_at = int(index * WD_LIT_MODEL_TEXELS);
    wd_lit_leaves model = lit_leaves(model_at);
    wd_sunlit_mix mixed = sunlit_tables(pixel);
    wd_crown crown = crown_of(tree, model);
    vec4 skylit = skylit_by_table(pixel, model_at, mixed, crown);
    wd_shelter shelter = ground_shelter(pixel);
    float free = stands_free(crown);
    crown.told = tables_hold(crown, free, shelter.herbs);
    wd_floor_sky on_floor = herbs_floor_sky(crown, pixel.rel);
    shelter = floor_shelter(shelter, on_floor, 1.0);
    site.alone = crown_alone(pixel, crown, skylit, shelter, on_floor, free);
    site.hot = mixed.disc_hot;
    mixed.opposite *= site.alone.share;
    mixed.eye = is_leaf(pixel) ? mixed.eye : mixed.wood_eye;
    vec2 sunlit = sunlit_of(model_at, mixed);
    if (is_leaf(pixel))
        site.place = leaf_place(pixel, crown, model, upper_sides(model_at, mixed), site.alone.share, sunlit, site.hot, cascade);
    else
        site.place = wood_place(pixel, crown, unpackHalf2x16(model.sun_curve), site.alone.share, sunlit, cascade);
    haze_end = wd_haze_place(shelter.beside, shelter.layer_m, pixel.rel.z - crown.foot_z);
    site.shelter = tree_shelter(pixel, site.place.rel, crown, shelter);
    light_past_neighbours(site.alone, pixel, crown, model, site.shelter, site.place);
    site.facing = is_leaf(pixel) ? vec4(site.place.normal, 0.0) : vec4(pixel.facing, facing_spread(pixel.facing));
    site.facing = mix(site.facing, leaves_seen(-pixel.direction), site.alone.share * site.place.cloud);
    return site;
}

wd_site ground_site(wd_pixel pixel, uint cascade)
{
    wd_site site;
    wd_shelter shelter = ground_shelter(pixel);
    haze_end = wd_haze_place(shelter.beside, shelter.layer_m, 0.0);
    wd_floor_sky on_floor = floor_sky(pixel.rel);
    if (is_curtain(pixel)) /* whose squares nobody has asked for */
        on_floor = NO_FLOOR;
    site.shelter = floor_shelter(shelter, on_floor, on_floor.stems * pixel.openness * through_herbs(shelter.herbs));
    site.alone = NOT_ALONE;
    site.alone.edge = edge_of(pixel, site.shelter, on_floor);
    site.place = ground_place(pixel);
    site.place.own = through_sward(pixel.openness, cascade);
    site.place.sheet = dot(pixel.normal, frame.sun_direction) > 0.0 ? pixel.normal : vec3(0.0);
    site.facing = vec4(pixel.normal, 0.0);
    site.hot = 1.0;
    return site;
}

/* What trees leave of the sun: by the maps, and beyond them, for which the canopy's cover stands. What cards shade
 * among themselves their own share holds. */
float sun_past_trees(wd_pixel pixel, uvec2 at, wd_site site, uint cascade)
{
    wd_place place = site.place;
    vec3 ahead = place.rel + frame.sun_direction * place.ahead_m;
    float circles = wd_pixel_turn(at.x, at.y, frame.sample_index);
    float past = tree_shadow(ahead, place.normal, place.sheet, place.bulges, cascade, circles);
    if (pixel.surface == 0u || pixel.lit >= 0.0) {
        float far_m = frame.cascades[WD_CASCADES - 1][WD_CASCADE_FAR_M];
        float out_of_maps = smoothstep(0.7, 0.95, pixel.axis_m / far_m);
        float beam = 0.67 / max(frame.sun_direction.z, 0.05);
        float own = pixel.surface == 0u ? 1.0 : max(pixel.openness, 1e-2);
        float stand = min(dot(frame.sunward, site.shelter.through) / own, 1.0);
        float in_stand = mix(1.0, STAND_NO_MAP, site.alone.leaf * (1.0 - site.alone.share));
        float without = pixel.surface == 0u ? 1.0 : site.hot * in_stand;
        past = mix(past, pow(stand, beam) / without, out_of_maps);
    }
    return past;
}

/* What comes of the bright sky about the sun: past the place's own leaves as the sun itself does, and by wider ways. */
float sky_by_sun(wd_pixel pixel, wd_site site, float ground_share, float past_trees)
{
    float way = WIDE_WAY / (max(frame.sun_direction.z, 0.0) + WIDE_HIGHER);
    way *= pixel.surface == 0u ? floor_way(site.shelter) : 1.0;
    float by_crown = min(sky_about_sun(site.alone) * wd_skylit_above(pixel.openness), 1.0);
    float wide_way = pow(mix(dot(frame.sunward, site.shelter.through), by_crown, site.alone.by_crown), way);
    wide_way += (1.0 - wide_way) * low_about_sun(frame.sun_direction.z) * dot(frame.sunward, site.alone.edge);
    float close = pixel.surface == 0u ? 0.0 : mix(NEAR_SUN, NEAR_SUN_BLADES, site.place.sward);
    float over_hills = mix(OVER_HILLS, 1.0, ground_share), leaf_way = site.place.own * past_trees;
    return mix(wide_way, leaf_way, close) * over_hills;
}

/* Snow lies on what lets light through and shines. */
void lay_snow(inout wd_place place, float snow)
{
    place.transmittance *= 1.0 - snow;
    place.waxed *= 1.0 - snow;
    place.gloss *= 1.0 - snow;
}

/* `sun_share` is what of the sun reaches the place, `ground_share` what the ground leaves of it. */
vec3 shade(wd_pixel pixel, uvec2 at, out float sun_share, out float ground_share)
{
    uint cascade = shadow_cascade(pixel.axis_m, pixel_noise(at, frame.sample_index));
    wd_site site;
    if ((PARTS & WD_PART_TREES) != 0u && pixel.surface != 0u)
        site = tree_site(pixel, cascade);
    else
        site = ground_site(pixel, cascade);
    lay_snow(site.place, pixel.snow);
    wd_place place = site.place;
    ground_share = ground_shadow(place.rel);
    float past_trees = sun_past_trees(pixel, at, site, cascade);
    vec2 past = past_discs(pixel, site.shelter, site.alone);
    sun_share = place.own * ground_share * past_trees * past.x;
    vec3 transmitted = pixel.albedo * place.transmittance * place.body;
    vec3 blade = within_wax(pixel.albedo, place.waxed);
    vec3 within_sun = within_wax(pixel.albedo * place.reflects, place.waxed_lit.x) * place.body;
    vec3 within_sky = within_wax(pixel.albedo * place.reflects_sky, place.waxed_lit.y) * place.body;
    vec3 sunlit = within_sun * place.sides.x + transmitted * place.sides.y;
    float scatters = is_single(pixel) ? mix(1.0, OWN_OF_ONE_LEAF, site.alone.share) * sky_about_sun(site.alone) : past_trees;
    site.alone.scattered *= sunlight() * (place.about * ground_share * scatters);
    vec3 mirror = wax_mirror(pixel.direction, pixel.normal);
    wd_around around = light_around(site.facing, mirror, site.shelter, ground_share, past_trees, site.alone,
                                    -pixel.direction.z);
    if (is_curtain(pixel)) /* before it lies bright haze, as the path tracer has it */
        around.front += 0.5 * frame.sky_irradiance;
    vec3 mirrored = mirrored_by_leaf(pixel, around, mirror, blade, sun_share);
    vec3 sheen = mix(place.coat * (is_single(pixel) ? mirrored : around.front),
                     sward_sheen(pixel.direction, place.over, site.shelter.floor_mean, site.alone.low), place.sward);
    vec3 skylit = past.y * place.sky * (around.front * within_sky + sheen * place.waxed + around.back * transmitted);
    float about_sun = sky_by_sun(pixel, site, ground_share, past_trees);
    vec3 from_sun = frame.sun_irradiance * sun_share + frame.circumsolar * about_sun;
    vec3 light = from_sun * (sunlit + place.gloss) + skylit;
    return light * PER_PI;
}
