#include "tree/buttress.h"

#include "tree/skeleton.h"

/* Vertices of a fin and the valley before it: a blade, or as few as show it, a wedge from valley to valley. */
enum { BLADE_VERTICES = 5, WEDGE_VERTICES = 2, LEAST_BLADED = 12, LEAST_WEDGED = 5 };
/* Fins that climb less of a tree are none. */
static const float LEAST_HEIGHT = 1e-4f;

int wd_buttress_sides(const struct wd_species *species, int most)
{
    int sides = (int)species->buttress.count * (most >= LEAST_BLADED ? BLADE_VERTICES : WEDGE_VERTICES);
    bool fins = species->buttress.height >= LEAST_HEIGHT && most >= LEAST_WEDGED && sides > most;
    return fins ? sides : most;
}

/* How far a fin reaches at height z: a concave slope from the ground to its own top. */
static float fin_reach_m(const struct wd_tree_form *form, int fin, float z_m, float radius_m,
                         float *share)
{
    const struct wd_species *species = form->species;
    uint32_t key = wd_hash3(form->key, 0xb077, (uint32_t)fin);
    float top = species->buttress.height * form->height_m *
                (0.6f + 0.55f * wd_hash_unit(key));
    float most = species->buttress.reach * form->dbh_m *
                 (0.6f + 0.6f * wd_hash_unit(wd_hash1(key)));
    float h = wd_clampf(z_m / top, 0, 1), slope = (1 - h) * (1 - h) * (1 - 0.35f * h);
    *share = 1 - h * h * h;
    return radius_m + wd_maxf(most - radius_m, 0) * slope;
}

void wd_buttress_outline(const struct wd_tree_form *form, float z_m, float radius_m, int sides,
                         int i, float place[2])
{
    int count = (int)form->species->buttress.count, vertices = sides / count;
    int fin = i / vertices, at = i % vertices;
    double turn = 2 * WD_PI * (double)i / (double)sides;
    double jitter = (double)wd_hash_unit(wd_hash3(form->key, 0xb07, (uint32_t)fin)) - 0.5;
    double axis = 2 * WD_PI * ((double)fin + 0.5 + 0.3 * jitter) / (double)count, share_d;
    float share, reach = fin_reach_m(form, fin, z_m, radius_m, &share) / radius_m;
    float thin = wd_clampf(0.05f * form->dbh_m / radius_m + 0.06f, 0.06f, 0.3f);
    /* valley, root, tip, tip, root: along the fin and across it, in radii; of a wedge valley and tip */
    float out[BLADE_VERTICES] = {0, 0.97f, reach, reach, 0.97f};
    float side[BLADE_VERTICES] = {0, -1.6f * thin, -0.6f * thin, 0.6f * thin, 1.6f * thin};
    if (vertices == WEDGE_VERTICES) {
        out[1] = reach;
        side[1] = 0;
    }
    double ca = wd_dcos(axis), sa = wd_dsin(axis), ct = wd_dcos(turn), st = wd_dsin(turn);
    double fin_x = (double)out[at] * ca - (double)side[at] * sa;
    double fin_y = (double)out[at] * sa + (double)side[at] * ca;
    if (at == 0) { /* the valley lies between two fins */
        double valley = 2 * WD_PI * (double)fin / (double)count;
        fin_x = 0.92 * wd_dcos(valley);
        fin_y = 0.92 * wd_dsin(valley);
    }
    share_d = (double)share;
    place[0] = (float)(ct + (fin_x - ct) * share_d);
    place[1] = (float)(st + (fin_y - st) * share_d);
}

/* Stems thinner than the first have a round flare, from the second on lobes are whole. */
static const float LOBED_FROM_M = 0.12f, LOBED_WHOLE_M = 0.4f;

static float lobe_strength(const struct wd_tree_form *form, float dbh_m)
{
    const struct wd_species *species = form->species;
    bool tree = species->form == WD_FORM_BROADLEAF || species->form == WD_FORM_CONIFER ||
                species->form == WD_FORM_SNAG;
    bool fins = species->buttress.count > 0 && species->buttress.height >= LEAST_HEIGHT;
    if (!tree || fins || species->root_flare <= 1)
        return 0;
    return (1 - form->youth) * wd_smoothf(LOBED_FROM_M, LOBED_WHOLE_M, dbh_m);
}

struct wd_root_lobes wd_root_lobes_of(const struct wd_tree_form *form, float dbh_m)
{
    struct wd_root_lobes lobes = {.strength = lobe_strength(form, dbh_m), .dbh_m = dbh_m};
    if (lobes.strength <= 0)
        return lobes;
    uint32_t key = wd_hash2(form->key, 0x2007);
    lobes.count = 4 + (int)(2.4f * wd_hash_unit(key) + 1.3f * wd_smoothf(0.4f, 1, dbh_m));
    for (int i = 0; i < lobes.count; i++) {
        uint32_t own = wd_hash2(key, (uint32_t)i);
        float jitter = 0.55f * (wd_hash_unit(own) - 0.5f);
        float turn = ((float)i + jitter) / (float)lobes.count + wd_hash_unit(wd_hash1(key));
        lobes.turn[i] = floorf(WD_LOBE_PLACES * turn) / WD_LOBE_PLACES;
        lobes.low[i] = 0.6f + 0.65f * wd_hash_unit(wd_hash2(own, 1));
        lobes.high[i] = lobes.low[i] * (0.4f + wd_hash_unit(wd_hash2(own, 2)));
    }
    return lobes;
}

void wd_root_lobes_at(const struct wd_root_lobes *lobes, float turn, float *low, float *high)
{
    double square = (double)(lobes->count * lobes->count), sum_low = 0, sum_high = 0;
    for (int i = 0; i < lobes->count; i++) {
        double off = wd_dcos(2 * WD_PI * (double)(turn - lobes->turn[i])) - 1;
        /* bells around a circle (von Mises), wider above */
        sum_low += (double)lobes->low[i] * wd_dexp(0.6 * square * off);
        sum_high += (double)lobes->high[i] * wd_dexp(0.28 * square * off);
    }
    *low = (float)sum_low;
    *high = (float)sum_high;
}

/* Ridges fade more slowly than the flare as a whole, and so hollows run up between them; near the ground roots
 * run out. */
struct wd_root_shape wd_root_shape_at(const struct wd_root_lobes *lobes, const struct wd_tree_form *form,
                                      float z_m)
{
    struct wd_root_shape shape = {.flare = wd_root_flare(form, lobes->dbh_m, z_m)};
    if (lobes->strength <= 0)
        return shape;
    float height = wd_maxf(z_m / lobes->dbh_m, -0.1f), up = wd_smoothf(0.1f, 1.1f, height);
    float lobed = lobes->strength * shape.flare * (1 - wd_smoothf(1, 2.2f, height));
    float most = form->species->root_flare - 1;
    float toe = 0.5f * lobes->strength * most * (float)wd_dexp(-(double)height / 0.16);
    shape.low = (1 - up) * 1.7f * lobed + toe;
    shape.high = up * 2.6f * lobed + 0.012f * lobes->strength;
    return shape;
}
