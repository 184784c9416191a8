#include <stdlib.h>

#include "base/memory.h"
#include "tree/foliage.h"
#include "tree/leaf_sprig.h"
#include "tree/look.h"

/* Bytes that the leaves, or flowers, of a full mesh may take with their outlines; more leaves are
 * kites, and more flowers than fit are left out. */
enum { OUTLINE_BYTES = 2600000 };
enum { REDUCED_SPRIG_TRIANGLES = 2 };

/* --- places ------------------------------------------------------------------------------ */

static struct wd_leaf_stand leaf_stand(const struct wd_leaf *leaf)
{
    return (struct wd_leaf_stand){
        .position_m = leaf->position_m,
        .axis = leaf->axis,
        .normal = leaf->normal,
        .shading = leaf->shading,
        .size_m = leaf->size_m,
        .flexibility = leaf->flexibility,
        .arch = wd_hash_unit(wd_hash2(leaf->key, 0xb3)),
        .form = leaf->key % WD_LEAF_VARIANTS,
        .tint = wd_pack_tint(leaf->tint, leaf->sky),
    };
}

/* A flower stands before a leaf that light reaches, turned to it; a panicle stands upright, a
 * catkin hangs from the twig. */
static struct wd_leaf_stand flower_stand(const struct wd_leaf *leaf,
                                         const struct wd_species *species)
{
    static const float white[3] = {1, 1, 1};
    struct wd_random random = wd_random_of(leaf->key, 0xf10);
    float up = species->flower.petals > 0 ? 0.35f : 2.5f;
    struct wd_leaf_stand place = leaf_stand(leaf);
    struct wd_vec3 facing = wd_v3_mad(leaf->shading, WD_V3(0, 0, 1), up);
    float hang = species->flower.hang;
    facing = wd_v3_mix(facing, WD_V3(0, 0, -2.5f), hang);
    place.normal = wd_v3_unit(wd_v3_mad(facing, wd_random_vec3(&random), 0.35f));
    place.axis = wd_v3_square(leaf->axis, place.normal);
    place.size_m = 0.01f * species->flower.size_cm * wd_random_range(&random, 0.75f, 1.1f);
    if (species->leaf.shape == WD_LEAF_BLADE) /* a plume grows with its tuft */
        place.size_m *= fminf(leaf->size_m / (0.01f * species->leaf.length_cm), 1);
    place.position_m = wd_v3_mad(leaf->position_m, leaf->shading,
                                 0.3f * leaf->size_m * (1 - hang));
    place.tint = wd_pack_tint(white, leaf->sky);
    return place;
}

void wd_foliage_pack(struct wd_tree_leaf *leaves, struct wd_leaf_box *box,
                     const struct wd_foliage *foliage, const struct wd_species *species)
{
    size_t count = foliage->count + foliage->flower_count;
    struct wd_leaf_stand *places = wd_alloc_array(count + 1, sizeof *places);
    for (size_t i = 0; i < foliage->count; i++)
        places[i] = leaf_stand(&foliage->leaves[i]);
    for (size_t i = 0; i < foliage->flower_count; i++)
        places[foliage->count + i] = flower_stand(&foliage->flowers[i], species);
    *box = wd_leaf_box_of(places, count);
    for (size_t i = 0; i < count; i++)
        leaves[i] = wd_leaf_pack(&places[i], box);
    free(places);
}

/* --- leaves ------------------------------------------------------------------------------ */

float wd_leaf_unit_area(const struct wd_species *species)
{
    float area = 0;
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        struct wd_leaf_template leaf;
        wd_leaf_template_init(&leaf, species, WD_LEAF_AS_BLADE, i);
        area += wd_leaf_template_area(&leaf) / WD_LEAF_VARIANTS;
        wd_leaf_template_finish(&leaf);
    }
    return area;
}

size_t wd_leaf_least_triangles(const struct wd_species *species)
{
    struct wd_leaf_template leaf;
    wd_leaf_template_init(&leaf, species, WD_LEAF_AS_KITE, 0);
    size_t triangles = leaf.index_count / 3;
    wd_leaf_template_finish(&leaf);
    return triangles ? triangles : 1;
}

static size_t template_bytes(const struct wd_leaf_template *leaf)
{
    return leaf->corner_count * sizeof(struct wd_tree_vertex) +
           leaf->index_count * sizeof(uint32_t);
}

/* With their outlines, or else with few triangles, as many as `bytes` allow. */
static struct wd_leaf_set flower_set(const struct wd_foliage *foliage,
                                     const struct wd_species *species, enum wd_leaf_form form,
                                     size_t bytes)
{
    struct wd_leaf_set set = {0};
    struct wd_leaf_template flower;
    if (foliage->flower_count == 0)
        return set;
    wd_flower_template_init(&flower, species, form);
    if (form == WD_LEAF_AS_BLADE && foliage->flower_count * template_bytes(&flower) > bytes) {
        wd_leaf_template_finish(&flower);
        wd_flower_template_init(&flower, species, WD_LEAF_AS_KITE);
    }
    size_t most = bytes / (template_bytes(&flower) + 1);
    wd_leaf_set_init(&set, &flower, 1);
    set.leaf_count = (uint32_t)(foliage->flower_count < most ? foliage->flower_count : most);
    set.own = 0.6f;
    wd_leaf_template_finish(&flower);
    return set;
}

/* An enlarged leaf grows from its middle. */
static void grow_from_middle(struct wd_leaf_template *leaf, float factor)
{
    for (size_t i = 0; i < leaf->corner_count; i++)
        leaf->corners[i].p = wd_v3_mix(WD_V3(0, 0.5f, 0), leaf->corners[i].p, factor);
}

static struct wd_leaf_set sprig_set(const struct wd_species *species, struct wd_sprig sprig,
                                    size_t count, float grow)
{
    struct wd_leaf_template templates[WD_LEAF_VARIANTS];
    struct wd_leaf_set set;
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        wd_leaf_sprig_init(&templates[i], species, sprig, i);
        grow_from_middle(&templates[i], grow);
    }
    wd_leaf_set_init(&set, templates, WD_LEAF_VARIANTS);
    set.leaf_count = (uint32_t)count;
    set.grain = 1 / sqrtf((float)sprig.leaves);
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++)
        wd_leaf_template_finish(&templates[i]);
    return set;
}

static bool is_frond(const struct wd_species *species)
{
    return species->leaf.compound == WD_COMPOUND_BIPINNATE ||
           (species->leaf.compound == WD_COMPOUND_PINNATE && species->leaf.leaflets > 16) ||
           (species->leaf.compound == WD_COMPOUND_SIMPLE && species->leaf.shape == WD_LEAF_BLADE);
}

static struct wd_leaf_set leaf_set(const struct wd_foliage *foliage,
                                   const struct wd_species *species, enum wd_leaf_form form)
{
    struct wd_leaf_template templates[WD_LEAF_VARIANTS];
    struct wd_leaf_set set;
    bool needles = species->leaf.shape == WD_LEAF_NEEDLES;
    /* sheets are alike */
    uint32_t forms = needles || is_frond(species) ? WD_LEAF_VARIANTS : 1;
    for (uint32_t i = 0; i < forms; i++)
        wd_leaf_template_init(&templates[i], species, form, i);
    wd_leaf_set_init(&set, templates, forms);
    set.leaf_count = (uint32_t)foliage->count;
    if (!needles && species->leaf.arch <= 0) {
        set.arch_least = 0.5f;
        set.arch_range = 1.2f;
    } else if (species->leaf.shape == WD_LEAF_BLADE) {
        set.arch_least = 0.45f;
        set.arch_range = 0.9f;
    }
    for (uint32_t i = 0; i < forms; i++)
        wd_leaf_template_finish(&templates[i]);
    return set;
}

float wd_foliage_mean_m(const struct wd_foliage *foliage)
{
    double area = 0;
    for (size_t i = 0; i < foliage->count; i++)
        area += (double)(foliage->leaves[i].size_m * foliage->leaves[i].size_m);
    return foliage->count ? (float)sqrt(area / (double)foliage->count) : 0;
}

/* Feathers keep their shape with a quarter of the leaflets, each four times as wide; a fern's pinnae
 * become single leaflets, as much narrower as there is light between their pinnules. */
static struct wd_species coarser_fronds(const struct wd_species *species)
{
    struct wd_species coarse = *species;
    if (species->leaf.compound == WD_COMPOUND_BIPINNATE) {
        coarse.leaf.compound = WD_COMPOUND_PINNATE;
        coarse.leaf.shape = WD_LEAF_LANCEOLATE;
        coarse.leaf.leaflet_width_cm *= 0.7f;
        return coarse;
    }
    int64_t leaflets = species->leaf.leaflets / 4 > 6 ? species->leaf.leaflets / 4 : 6;
    coarse.leaf.leaflet_width_cm *= (float)species->leaf.leaflets / (float)leaflets;
    coarse.leaf.leaflets = leaflets;
    return coarse;
}

static bool outlines_fit(const struct wd_foliage *foliage, const struct wd_species *species,
                         size_t bytes)
{
    struct wd_leaf_template leaf;
    wd_leaf_template_init(&leaf, species, WD_LEAF_AS_BLADE, 0);
    bool fit = foliage->count * template_bytes(&leaf) <= bytes;
    wd_leaf_template_finish(&leaf);
    return fit;
}

/* What each of the first `count` leaves is drawn as, where it stands for several; compound leaves
 * that are too many for their outlines are sprigs of leaflets at any size. No leaves: as it is. */
static struct wd_sprig sprig_of(const struct wd_foliage *foliage, const struct wd_species *species,
                                size_t count, size_t most_triangles, bool outlined)
{
    bool compound = species->leaf.compound != WD_COMPOUND_SIMPLE;
    float mean_m = wd_foliage_mean_m(foliage), real_m = 0.01f * species->leaf.length_cm;
    float real = mean_m * mean_m / (real_m * real_m) * (float)foliage->count / (float)(count + 1);
    if (species->leaf.shape == WD_LEAF_NEEDLES || is_frond(species) ||
        (real < WD_SPRIG_FROM && (outlined || !compound)))
        return (struct wd_sprig){0};
    size_t wanted = (size_t)(real * (compound ? (float)species->leaf.leaflets : 1) + 0.5f);
    wanted = wanted < WD_SPRIG_LEAVES ? wanted : WD_SPRIG_LEAVES;
    if (2 * wanted <= most_triangles)
        return (struct wd_sprig){(uint32_t)wanted, 2};
    return (struct wd_sprig){(uint32_t)(wanted < most_triangles ? wanted : most_triangles), 1};
}

static size_t outline_triangles(const struct wd_species *species)
{
    struct wd_leaf_template leaf;
    wd_leaf_template_init(&leaf, species, WD_LEAF_AS_BLADE, 0);
    size_t triangles = leaf.index_count / 3;
    wd_leaf_template_finish(&leaf);
    return triangles;
}

static struct wd_sprig full_sprig(const struct wd_foliage *foliage,
                                  const struct wd_species *species, bool outlined)
{
    size_t triangles = outlined ? outline_triangles(species) : foliage->sprig_triangles;
    size_t budget = foliage->all_sprig_triangles / (foliage->count + 1); /* small trees */
    triangles = triangles < budget ? budget : triangles;
    return sprig_of(foliage, species, foliage->count, triangles, outlined);
}

float wd_foliage_reach(const struct wd_foliage *foliage, const struct wd_species *species)
{
    bool outlined = outlines_fit(foliage, species, OUTLINE_BYTES);
    struct wd_sprig sprig = full_sprig(foliage, species, outlined);
    return sprig.leaves > 1 ? wd_sprig_reach((int)sprig.leaves) + 1 / sqrtf((float)sprig.leaves) : 1;
}

void wd_foliage_sets(struct wd_leaf_set sets[WD_LEAF_SETS], const struct wd_foliage *foliage,
                     const struct wd_species *species)
{
    struct wd_species drawn = *species;
    if (is_frond(species) && species->leaf.compound != WD_COMPOUND_SIMPLE &&
        !outlines_fit(foliage, species, OUTLINE_BYTES))
        drawn = coarser_fronds(species);
    bool fit = outlines_fit(foliage, &drawn, OUTLINE_BYTES);
    struct wd_sprig sprig = full_sprig(foliage, species, fit);
    sets[WD_SET_LEAVES] =
        sprig.leaves > 1 ? sprig_set(species, sprig, foliage->count, 1)
                         : leaf_set(foliage, &drawn, fit ? WD_LEAF_AS_BLADE : WD_LEAF_AS_KITE);
    sets[WD_SET_FLOWERS] = flower_set(foliage, species, WD_LEAF_AS_BLADE, OUTLINE_BYTES);
}

/* Factor on the length of the first leaves, of this area at unit length, with which they have the
 * area of all. */
static float reduced_growth(const struct wd_foliage *foliage, size_t count, float area)
{
    float sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += area * foliage->leaves[i].size_m * foliage->leaves[i].size_m;
    return sum > 0 ? sqrtf(foliage->area_m2 / sum) : 1;
}

/* A shoot of needles as two slender triangles that part at their foot, with the kite's area. */
static struct wd_leaf_set fork_set(const struct wd_leaf_template *kite, size_t count, float spread)
{
    struct wd_leaf_template forks[WD_LEAF_VARIANTS] = {0};
    struct wd_leaf_set set;
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++) {
        struct wd_random random = wd_random_of(i, 0xf02c);
        for (int k = 0; k < 2; k++) {
            float from = 0.3f * (float)k, up = spread * wd_random_signed(&random);
            struct wd_vec3 aside = WD_V3(k ? -spread : spread, 1, up);
            struct wd_vec3 d = wd_v3_unit(wd_v3_mad(aside, wd_random_vec3(&random), 0.25f));
            struct wd_vec3 across = wd_v3_mad(WD_V3(1, 0, 0), wd_random_vec3(&random), 0.5f);
            across = wd_v3_square(across, d);
            wd_leaf_add_needle(&forks[i], WD_V3(0, from, 0), d, across, 1 - 0.75f * from, 0.3f);
        }
        wd_leaf_template_scale(&forks[i], wd_leaf_template_area(kite));
    }
    wd_leaf_set_init(&set, forks, WD_LEAF_VARIANTS);
    set.leaf_count = (uint32_t)count;
    for (uint32_t i = 0; i < WD_LEAF_VARIANTS; i++)
        wd_leaf_template_finish(&forks[i]);
    return set;
}

/* The first leaves, kites or sprigs, with the area of all. */
static struct wd_leaf_set few_set(const struct wd_foliage *foliage,
                                  const struct wd_species *species, size_t count)
{
    /* a kite faces one way, the needles of a brush all ways, and they hide one another */
    bool brushes = species->leaf.shape == WD_LEAF_NEEDLES &&
                   species->leaf.needles != WD_NEEDLES_AROUND;
    struct wd_species plain = *species;
    if (species->leaf.shape == WD_LEAF_NEEDLES) {
        plain.leaf.shape = WD_LEAF_ELLIPTIC;
        plain.leaf.width_cm = (brushes ? 0.75f : 0.5f) * plain.leaf.length_cm;
        plain.leaf.stalk_cm = 0;
    }
    struct wd_leaf_template kite;
    wd_leaf_template_init(&kite, &plain, WD_LEAF_AS_KITE, 0);
    float grow = reduced_growth(foliage, count, wd_leaf_template_area(&kite));
    struct wd_sprig sprig = sprig_of(foliage, species, count, REDUCED_SPRIG_TRIANGLES, true);
    grow_from_middle(&kite, (brushes ? sqrtf(0.905f) : 1) * grow);
    struct wd_leaf_set set;
    if (sprig.leaves > 1) {
        set = sprig_set(species, sprig, count, grow);
    } else if (species->leaf.shape == WD_LEAF_NEEDLES) {
        set = fork_set(&kite, count, brushes ? 0.7f : 0.35f);
        set.own = brushes ? 0.1f : set.own;
    } else {
        wd_leaf_set_init(&set, &kite, 1);
        set.leaf_count = (uint32_t)count;
    }
    wd_leaf_template_finish(&kite);
    return set;
}

void wd_foliage_sets_reduced(struct wd_leaf_set sets[WD_LEAF_SETS],
                             const struct wd_foliage *foliage, const struct wd_species *species,
                             size_t count)
{
    struct wd_species coarse = *species;
    if (is_frond(species) && species->leaf.compound != WD_COMPOUND_SIMPLE)
        coarse = coarser_fronds(species);
    if (is_frond(species) && foliage->count <= count &&
        outlines_fit(foliage, &coarse, OUTLINE_BYTES / 4))
        sets[WD_SET_LEAVES] = leaf_set(foliage, &coarse, WD_LEAF_AS_BLADE);
    else
        sets[WD_SET_LEAVES] = few_set(foliage, species,
                                      count < foliage->count ? count : foliage->count);
    sets[WD_SET_FLOWERS] = flower_set(foliage, species, WD_LEAF_AS_KITE, OUTLINE_BYTES / 4);
}
