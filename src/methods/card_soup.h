/* card_soup.h: the cards of whole ranges of trees, made ready for drawing by compute.
 *
 * A vertex costs the vertex stage nothing but its fetch, what the view cannot see is left out, and
 * all cards of a view are one indirect draw. For the camera that draw writes only which card a
 * pixel shows; what the card's surface is like there is found once a pixel, afterwards. Cards stand
 * in the order of the ranges: near ones first, the same on every run. */
#ifndef WD_METHODS_CARD_SOUP_H
#define WD_METHODS_CARD_SOUP_H

#include "methods/tree_draw.h"
#include "shared/card_soup.h"

struct wd_card_soup {
    struct wd_pipeline count[2], expand[2], draw[2]; /* [WD_PASS_CAMERA, WD_PASS_SHADOW] */
    struct wd_pipeline scan, resolve;
    struct wd_buffer firsts;          /* uint32_t[chunks] */
    struct wd_buffer command;         /* struct wd_draw_indexed */
    struct wd_buffer cards, vertices; /* struct wd_card_flat[cards], wd_card_vertex[4 cards] */
    struct wd_image visible;          /* of the camera: card + 1, 0 none; as large as the picture */
    struct wd_card_chunk *chunks;     /* of the view at hand */
    size_t chunk_count, chunk_capacity;
    uint32_t tree_count, most_cards;  /* of the view at hand, before culling */
};

bool wd_card_soup_init(struct wd_card_soup *soup, struct wd_gpu *gpu);
void wd_card_soup_finish(struct wd_card_soup *soup, struct wd_gpu *gpu);

/* Takes as many ranges from the front of the selection as the soup holds (the last may be taken in
 * part), records the making of their cards and, for the camera, finds which of them show. Outside
 * of any rendering. */
void wd_card_soup_make(struct wd_card_soup *soup, const struct wd_tree_draw *draw,
                       struct wd_selection *selection);

/* Draws what was made last into the open rendering: before anything else of the view. Triangles
 * count as before the device leaves out what the view does not see. */
void wd_card_soup_draw(const struct wd_card_soup *soup, const struct wd_tree_draw *draw);

#endif
