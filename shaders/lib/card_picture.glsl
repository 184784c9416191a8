/* Where things are in the pictures of cards. Expects shared/forest.h. */

bool card_lies(wd_model model)
{
    return WD_CARD_LIES(model.half_width_m, model.bottom_m, model.top_m);
}

/* Where a card's place (right and down, 0..1) is in its picture; `lies`: as of that. */
vec2 card_picture_uv(vec2 place, bool lies)
{
    return lies ? vec2(place.y, 1.0 - place.x) : place;
}
