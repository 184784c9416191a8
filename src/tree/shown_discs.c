/* What is nearest is drawn first and stays: a bit a pixel is all that a picture needs. */
#include <stdlib.h>

#include "base/memory.h"
#include "shared/hash.h"
#include "shared/sun_ways.h"
#include "tree/four.h"
#include "tree/radix.h"
#include "tree/shown.h"

enum { BATCH = 64, WORD = 64, WORDS = (WD_SILHOUETTE + WORD - 1) / WORD, LEAF = 256 };

void wd_shown_add(struct wd_shown *sum, const struct wd_shown *shown, double weight)
{
    sum->covered += weight * shown->covered;
    sum->wood += weight * shown->wood;
    sum->lower += weight * shown->lower;
    for (int class = 0; class < 2; class++)
        sum->openness[class] += weight * shown->openness[class];
}

/* --- facets ------------------------------------------------------------------------------ */

void wd_faces_init(struct wd_faces *faces, const struct wd_tree_points *discs)
{
    *faces = (struct wd_faces){
        .discs = discs,
        .normals = wd_alloc_array(discs->count + 1, sizeof *faces->normals),
        .lots = wd_alloc_array(discs->count + 1, sizeof *faces->lots),
    };
    for (size_t i = 0; i < discs->count; i++) {
        wd_unpack_normal(discs->points[i].face, faces->normals[i]);
        faces->lots[i] = (uint8_t)wd_hash2((uint32_t)i, 0x1e5);
    }
}

void wd_faces_finish(struct wd_faces *faces)
{
    free(faces->normals);
    free(faces->lots);
    *faces = (struct wd_faces){0};
}

/* Over the mean of faces of every direction, for leaves. */
static float facing_of(uint32_t kind, const float normal[3], struct wd_vec3 toward)
{
    float cosine = wd_v3_dot(wd_v3_of(normal), toward);
    return kind & WD_POINT_ONE_SIDED ? wd_maxf(cosine, 0) : 2 * fabsf(cosine);
}

struct wd_facet *wd_facets_of(const struct wd_faces *faces, const struct wd_silhouette *frame)
{
    const struct wd_tree_points *discs = faces->discs;
    struct wd_facet *facets = wd_alloc_array(discs->count + 1, sizeof *facets);
    uint32_t eye = wd_sun_mix(frame->toward), ways[256];
    for (uint32_t lot = 0; lot < 256; lot++)
        ways[lot] = wd_sun_way_by_lot(eye, lot);
    for (size_t i = 0; i < discs->count; i++) {
        const struct wd_tree_point *point = &discs->points[i];
        struct wd_facet *facet = &facets[i];
        wd_silhouette_project(frame, point->position_m, facet->at);
        facet->toward = wd_v3_dot(wd_v3_of(point->position_m), frame->toward);
        facet->facing = facing_of(point->kind, faces->normals[i], frame->toward);
        facet->seen = discs->lit[i] >> ways[faces->lots[i]] & 1;
        facet->openness = (uint8_t)(point->albedo >> 24);
    }
    return facets;
}

/* --- windows ----------------------------------------------------------------------------- */

static void set_disc(struct wd_disc_window *window, size_t i, const struct wd_facet *facet,
                     bool leaf, float close)
{
    window->at[0][i] = facet->at[0];
    window->at[1][i] = facet->at[1];
    window->facing[i] = facet->facing * wd_disc_open(facet->seen, close);
    window->looks[i] = facet->openness + (leaf ? LEAF : 0);
}

static const struct wd_facet *facet_at(const struct wd_facet_run *run, size_t i)
{
    size_t at = run->first + i;
    return &run->facets[at < run->all ? at : at - run->all];
}

void wd_disc_window_init(struct wd_disc_window *window, const struct wd_facet_run runs[2],
                         float close, float nearer_m)
{
    size_t wood = runs[0].count, count = wood + runs[1].count;
    uint32_t *keys = wd_alloc_array(count + 1, sizeof *keys);
    uint32_t *order = wd_alloc_array(count + 1, sizeof *order);
    *window = (struct wd_disc_window){
        .at = {wd_alloc_array(count + 3, sizeof(float)), wd_alloc_array(count + 3, sizeof(float))},
        .facing = wd_alloc_array(count + 3, sizeof(float)),
        .looks = wd_alloc_array(count + 3, sizeof(int32_t)),
        .count = count,
    };
    for (size_t i = 0; i < count; i++) {
        const struct wd_facet *facet = facet_at(&runs[i >= wood], i < wood ? i : i - wood);
        keys[i] = ~wd_radix_key(facet->toward + facet->seen * ((1 - close) * nearer_m));
    }
    wd_radix_order(order, keys, count);
    for (size_t i = 0; i < count; i++) {
        size_t from = order[i];
        bool leaf = from >= wood;
        set_disc(window, i, facet_at(&runs[leaf], leaf ? from - wood : from), leaf, close);
    }
    free(keys);
    free(order);
}

void wd_disc_window_finish(struct wd_disc_window *window)
{
    free(window->at[0]);
    free(window->at[1]);
    free(window->facing);
    free(window->looks);
    *window = (struct wd_disc_window){0};
}

/* --- pictures ---------------------------------------------------------------------------- */

/* First and end of the pixels whose middles squares reach over. */
struct squares {
    int32_t first[2][BATCH], end[2][BATCH], reaches[BATCH];
};

static inline void place_squares(struct squares *squares, const struct wd_disc_window *window,
                                 size_t from, size_t count, const float squared_m2[2], float scale)
{
    for (size_t i = 0; i < count; i += 4) {
        wd_four_ints looks, reaches = {1, 1, 1, 1};
        memcpy(&looks, window->looks + from + i, sizeof looks);
        wd_four squared = wd_four_choose(looks >= LEAF, wd_four_of(squared_m2[1]),
                                         wd_four_of(squared_m2[0]));
        wd_four radius = wd_four_root(squared * wd_four_load(window->facing + from + i)) * scale;
        wd_four half = radius * 0.886227f;
        for (int axis = 0; axis < 2; axis++) {
            wd_four at = wd_four_load(window->at[axis] + from + i);
            wd_four_ints first = wd_silhouette_pixels(at - half);
            wd_four_ints end = wd_silhouette_pixels(at + half);
            reaches &= first < end;
            memcpy(squares->first[axis] + i, &first, sizeof first);
            memcpy(squares->end[axis] + i, &end, sizeof end);
        }
        memcpy(squares->reaches + i, &reaches, sizeof reaches);
    }
}

/* Covers a square; returns how many of its pixels were not covered yet. */
static inline uint32_t cover(uint64_t covered[WORDS][WD_SILHOUETTE], const struct squares *squares,
                             int i)
{
    uint32_t count = 0;
    int first = squares->first[0][i], last = squares->end[0][i] - 1;
    for (int word = first / WORD; word <= last / WORD; word++) {
        uint64_t bits = ~(uint64_t)0;
        bits = word == first / WORD ? bits << first % WORD : bits;
        bits = word == last / WORD ? bits & ~(uint64_t)0 >> (WORD - 1 - last % WORD) : bits;
        for (int y = squares->first[1][i]; y < squares->end[1][i]; y++) {
            count += (uint32_t)__builtin_popcountll(bits & ~covered[word][y]);
            covered[word][y] |= bits;
        }
    }
    return count;
}

WD_FOUR_TWICE
struct wd_shown wd_shown_discs(const struct wd_disc_window *window, const float squared_m2[2],
                               float scale, const struct wd_silhouette *before)
{
    uint64_t covered[WORDS][WD_SILHOUETTE] = {0};
    for (int y = 0; y < WD_SILHOUETTE && before; y++)
        for (int i = 0; i < WD_SILHOUETTE / 8; i++)
            covered[i / 8][y] |= (uint64_t)before->covered[y][i] << (i % 8 * 8);
    uint32_t counts[2] = {0}, openness[2] = {0};
    for (size_t from = 0; from < window->count; from += BATCH) {
        struct squares squares;
        int reaching[BATCH + 1], found = 0;
        int count = window->count - from < BATCH ? (int)(window->count - from) : BATCH;
        place_squares(&squares, window, from, (size_t)count, squared_m2, scale);
        for (int i = 0; i < count; i++) {
            reaching[found] = i;
            found += squares.reaches[i];
        }
        for (int k = 0; k < found; k++) {
            int32_t look = window->looks[from + (size_t)reaching[k]];
            uint32_t fresh = cover(covered, &squares, reaching[k]);
            counts[look >= LEAF] += fresh;
            openness[look >= LEAF] += fresh * (uint32_t)(look % LEAF);
        }
    }
    return (struct wd_shown){.covered = counts[0] + counts[1], .wood = counts[0],
                             .openness = {openness[0], openness[1]}};
}
