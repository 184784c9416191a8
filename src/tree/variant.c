#include "tree/variant.h"

#include <math.h>
#include <string.h>

#include "base/color.h"
#include "shared/mixed.h"
#include "tree/look.h"
#include "tree/look_map.h"

/* The middle of its part of the range. */
static float variant_height(const struct wd_species *species, uint32_t variant, uint32_t variants)
{
    float share = ((float)variant + 0.5f) / (float)variants, range_m[2];
    wd_species_variant_range_m(species, range_m);
    return range_m[0] + (range_m[1] - range_m[0]) * share;
}

struct wd_grow_params wd_variant_params(const struct wd_scene *scene, uint32_t index)
{
    uint32_t variants = (uint32_t)scene->variants, variant = index % variants;
    if (scene->individuals)
        return scene->individuals[index];
    const struct wd_species *species = &scene->species[index / variants];
    return (struct wd_grow_params){
        .seed = variant + 1,
        .height_m = species->clip_box_m[2] > 0 ? 0 : variant_height(species, variant, variants),
        .openness = species->openness,
    };
}

/* How far an individual is ahead of its species' mean in the season, -1..1. */
static float variant_phase(const struct wd_scene *scene, uint32_t index)
{
    float variants = (float)scene->variants;
    return 2 * ((float)(index % (uint32_t)scene->variants) + 0.5f) / variants - 1;
}

struct wd_species wd_variant_species(const struct wd_scene *scene, uint32_t index)
{
    struct wd_species species = scene->species[index / (uint32_t)scene->variants];
    float phase = variant_phase(scene, index);
    float other = species.leaf.season_count[phase > 0];
    if (other <= 0 && species.leaf.season_count[phase < 0] <= 0)
        return species; /* no season */
    float share = 1 + (other - 1) * fabsf(phase);
    species.leaf.count = (int64_t)((float)species.leaf.count * share);
    species.leaf.area_index *= share;
    return species;
}

bool wd_variant_grow(struct wd_tree_model *model, const struct wd_scene *scene, uint32_t index,
                     const struct wd_log *log)
{
    const struct wd_grow_params params = wd_variant_params(scene, index);
    const struct wd_species species = wd_variant_species(scene, index);
    return wd_tree_grow(model, &species, &params, log);
}

/* A byte for each ring of the eye. */
static void pack_rings(uint32_t packed[2], const float *of, size_t stride, float most)
{
    packed[0] = packed[1] = 0;
    for (uint32_t ring = 0; ring < WD_EYE_RINGS; ring++)
        packed[ring / 4] |= (uint32_t)wd_unorm_encode(of[ring * stride] / most) << (8 * (ring % 4));
}

void wd_variant_describe(struct wd_model *model, const struct wd_scene *scene, uint32_t index,
                         const struct wd_tree_model *grown)
{
    uint32_t species_index = index / (uint32_t)scene->variants;
    const struct wd_species *species = &scene->species[species_index];
    *model = (struct wd_model){
        .height_m = grown->height_m,
        .crown_m = fmaxf(2.0f * grown->crown_radius_m, 0.1f),
        .flexibility = species->flexibility,
        .look_layer = WD_LOOK_LAYERS * species_index,
        .crown_base_m = grown->crown_base_m,
        .roughness = species->form == WD_FORM_GRASS ? -wd_leaf_roughness(species)
                                                    : wd_leaf_roughness(species),
        .moss = species->bark.moss,
        .fall_mps = species->form == WD_FORM_FALLING ? 1.0f : 0,
        .phase = variant_phase(scene, index),
        .mixed = WD_MIXED_EVEN,
    };
    pack_rings(model->wood_seen, grown->wood_seen, 1, 1);
    pack_rings(model->stem_seen, grown->stem_seen, 1, 1);
    for (int k = 0; k < 3; k++) {
        float late = species->leaf.season_color[0][k], early = species->leaf.season_color[1][k];
        model->behind[k] = late > 0 ? late : 1;
        model->ahead[k] = early > 0 ? early : 1;
        model->transmittance[k] =
            species->leaf.transmittance[k] / fmaxf(species->leaf.color[k], 1e-3f);
    }
    model->full_growth = grown->leaf_growth[0];
    model->reduced_growth = grown->leaf_growth[1];
    memcpy(model->seen_m2, grown->seen_m2, sizeof model->seen_m2);
}

/* The texels of a kind. */
static void pack_sunlit(uint32_t *texels, const struct wd_tree_model *grown, uint32_t kind)
{
    for (uint32_t place = 0; place < WD_SUNLIT_PLACES; place++) {
        uint32_t turn = place % WD_SUNLIT_TURNS, ring = place / WD_SUNLIT_TURNS % WD_EYE_RINGS;
        uint32_t turn_on = turn + 1 < WD_SUNLIT_TURNS ? 1 : 0;
        uint32_t ring_on = ring + 1 < WD_EYE_RINGS ? WD_SUNLIT_TURNS : 0;
        const uint32_t of[4] = {place, place + turn_on, place + ring_on, place + ring_on + turn_on};
        for (int k = 0; k < 4; k++) {
            const float *sunlit = &grown->sunlit[of[k]][2 * kind];
            texels[4 * place + k] = wd_pack_uv(sunlit[0], kind == WD_SUNLIT_LEAVES ? 0 : sunlit[1]);
        }
    }
}

static void pack_skylit(uint32_t *texels, const struct wd_tree_model *grown)
{
    for (uint32_t place = 0; place < WD_SKYLIT_PLACES; place++) {
        uint32_t ring_on = place % WD_EYE_RINGS + 1 < WD_EYE_RINGS ? 1 : 0;
        for (uint32_t k = 0; k < 4; k++) {
            const float *skylit = &grown->skylit[place + k / 2 * ring_on][k % 2 * 2];
            texels[4 * place + k] = wd_pack_uv(skylit[0], skylit[1]);
        }
    }
}

static uint32_t pack_bytes(const float *shares, float last)
{
    const float of[4] = {shares[0], shares[1], shares[2], last};
    uint32_t packed = 0;
    for (int k = 0; k < 4; k++)
        packed |= (uint32_t)wd_unorm_encode(of[k]) << (8 * k);
    return packed;
}

static void pack_upper(uint32_t *texels, const struct wd_tree_model *grown)
{
    for (uint32_t ring = 0; ring < WD_EYE_RINGS; ring++)
        for (uint32_t on = 0; on < 2; on++) {
            const float *upper = grown->upper[ring + on < WD_EYE_RINGS ? ring + on : ring];
            texels[4 * ring + on] = pack_bytes(upper + WD_UPPER_REFLECTS, upper[WD_UPPER_SEEN]);
            texels[4 * ring + 2 + on] = pack_bytes(upper + WD_UPPER_TRANSMITS, upper[WD_UPPER_MIRRORS] / WD_UPPER_MIRRORS_MOST);
        }
}

static uint32_t pack_ratios(const float ratios[3])
{
    uint32_t packed = 0;
    for (int k = 0; k < 3; k++)
        packed |= (uint32_t)(fminf(ratios[k], WD_PALER_MOST) * (WD_PALER_STEPS / WD_PALER_MOST) + 0.5f) << (10 * k);
    return packed;
}

static uint32_t paler_below(const struct wd_species *species)
{
    float upper[3] = {1, 1, 1}, lower[3] = {1, 1, 1}, ratios[3];
    if (!species->imported) {
        wd_look_color(species, WD_LOOK_LEAF, upper);
        wd_look_color(species, WD_LOOK_LEAF_BACK, lower);
    }
    for (int k = 0; k < 3; k++)
        ratios[k] = lower[k] / fmaxf(upper[k], 1e-3f);
    return pack_ratios(ratios) | (species->leaf.shape == WD_LEAF_NEEDLES ? WD_PALER_ANY_WAY : 0);
}

static float petal_leaf_green(const struct wd_species *species)
{
    float leaf[3];
    if (species->imported || species->flower.count <= 0)
        return 0;
    wd_look_color(species, WD_LOOK_LEAF, leaf);
    return species->flower.petals > 0 ? leaf[1] : -leaf[1];
}

void wd_variant_describe_light(struct wd_lit_model *lit, const struct wd_species *species,
                               const struct wd_model *model, const struct wd_tree_model *grown)
{
    const float EVERY_WAY = 0.5f; /* mean |z| of faces turned so */
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    uint32_t leaves = grown->sets[0][WD_SET_LEAVES].leaf_count; /* none of imported models */
    bool all = leaves > 0 && grown->sets[1][WD_SET_LEAVES].leaf_count == leaves;
    lit->leaves = (struct wd_lit_leaves){
        .base_petals = wd_pack_uv(model->crown_base_m / model->height_m, petal_leaf_green(species)),
        .cloud_wax = wd_pack_uv(grown->cloud_wax[0], grown->cloud_wax[1]),
        .sun_curve = wd_pack_uv(grown->sun_curve[0], grown->sun_curve[1]),
        .paler = paler_below(species),
        .through = pack_ratios(model->transmittance) | (all ? WD_THROUGH_ALL_LEAVES : 0),
        .again_low = wd_pack_uv(grown->recollision, grown->low_sky),
        .near_shade = wd_pack_uv(grown->near_shade[0], grown->near_shade[1]),
        .rough_flat = wd_pack_uv(model->roughness, needles ? EVERY_WAY : grown->flatness),
    };
    for (uint32_t kind = WD_SUNLIT_CARDS; kind <= WD_SUNLIT_LEAVES; kind++)
        pack_sunlit(lit->sunlit + 4 * WD_SUNLIT_PLACES * kind, grown, kind);
    pack_skylit(lit->skylit, grown);
    pack_upper(lit->upper, grown);
    pack_rings(lit->sky_wax, &grown->upper[0][WD_UPPER_SKY_WAX], WD_UPPER_KINDS, WD_UPPER_SKY_WAX_MOST);
    pack_rings(lit->open, &grown->upper[0][WD_UPPER_OPEN], WD_UPPER_KINDS, 1);
}
