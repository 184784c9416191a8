/* Where leaves, wood and ground stand in their crown's shade, and which of their sides the light meets.
 * Expects what lib/shade.glsl does, which includes it. */

/* What light meets at a pixel. */
struct wd_place {
    vec3 rel;           /* where it is taken to be */
    vec3 normal;        /* for skylight and for the shadow maps */
    float cloud;        /* 1: that is the crown's, and the pixel shows many leaves */
    vec3 sheet;         /* normal of a leaf's side that is to the sun, where maps hold leaves; or none */
    float bulges;       /* 1: wood, which is round, in maps, too */
    float own;          /* share of the sun left after the tree's own leaves */
    float about;        /* the same of the leaves about, by depth */
    float ahead_m;      /* how far toward the sun to go before asking the maps */
    vec2 sides;         /* share of the sun reflected and transmitted toward the eye */
    vec3 reflects;      /* albedo of the leaves that reflect the sun over the albedo of all that are seen, */
    vec3 reflects_sky;  /* and of those that reflect the sky's light */
    vec3 transmittance; /* over albedo */
    float gloss;
    float coat;         /* share of light from everywhere that wax mirrors: of one leaf, light about the
                           mirrored ray; of many, light that falls on them */
    float waxed;        /* share of upper sides among leaves seen, */
    vec2 waxed_lit;     /* and among those that reflect the sun and the sky's light */
    float body;         /* share of the light from within that their wax lets out toward the eye */
    float sky;          /* factor on the sky's light */
    float sward;        /* 1: a blade in a sward, */
    float over;         /* under so many layers of others */
};

wd_place ground_place(wd_pixel pixel)
{
    wd_place place;
    place.rel = pixel.rel;
    place.normal = pixel.normal;
    place.cloud = 0.0;
    place.sheet = vec3(0.0);
    place.bulges = 0.0;
    place.own = place.about = 1.0;
    place.ahead_m = 0.0;
    place.sides = vec2(facing_lit(pixel.facing), 0.0);
    place.reflects = place.reflects_sky = vec3(1.0);
    place.transmittance = vec3(0.0);
    place.gloss = 0.0;
    place.coat = 0.0;
    place.waxed = 0.0;
    place.waxed_lit = vec2(0.0);
    place.body = place.sky = 1.0;
    place.sward = 0.0;
    place.over = 0.0;
    return place;
}

/* Share of a leaf's shade that a shadow map of such texels tells: those wider than leaves mix what is lit
 * with what is not, and the eye sees more of the former. */
float map_holds_leaves(uint cascade, float free)
{
    float texel_m = cascade_numbers(cascade)[WD_CASCADE_TEXEL_M];
    return cascade < WD_LEAF_CASCADES ? 1.0 - free * smoothstep(0.04, 0.12, texel_m) : 0.0;
}

/* The same of leaves that the map holds as the eye sees them: how far it tells what shades them from close
 * by, where the look-up leaves out a texel. By coarse maps alone forests from within are 7 % too bright in
 * green (5 with this), and swards, whose blades are so many times thinner, too: by path-traced hedge rows,
 * whose meadow is a tenth too dark if maps tell nothing of blades. */
const float BLADES_THINNER = 2.4;

float map_tells_leaves(uint cascade, float sward)
{
    float texel_m = cascade_numbers(cascade)[WD_CASCADE_TEXEL_M] * mix(1.0, BLADES_THINNER, sward);
    return cascade < WD_LEAF_CASCADES ? 1.0 - smoothstep(0.02, 0.05, texel_m) : 0.0;
}

/* The same of leaves of meshes: what such maps do not tell of them is known (near_shade). */
float map_holds_mesh(uint cascade)
{
    float texel_m = cascade_numbers(cascade)[WD_CASCADE_TEXEL_M];
    return cascade < WD_LEAF_CASCADES ? 1.0 - smoothstep(0.10, 0.20, texel_m) : 0.0;
}

/* Of the nearest texel: one fetch instead of four. */
vec4 canopy_light_near(vec2 place_m, int layer)
{
#ifdef CANOPY_LIGHT
    vec2 at = clamp(canopy_at(place_m), 0.0, 0.9999);
    return texelFetch(CANOPY_LIGHT, ivec3(at * vec2(textureSize(CANOPY_LIGHT, 0).xy), layer), 0);
#else
    return vec4(1.0);
#endif
}

/* By the sky over the ground beside the crown, toward the sun: whether the plant stands free of trees. */
float stands_free(wd_crown crown)
{
    vec2 center = crown.center_rel.xy + push.camera_m;
    vec4 open = canopy_light_near(center + 1.5 * crown.radii_m.x * frame.sun_direction.xy, 0);
    return smoothstep(0.2, 0.5, 0.25 * dot(open, open));
}

/* A model's tables hold for trees and shrubs, and for herbs that stand free, of trees (`free`) and of one another. */
float tables_hold(wd_crown crown, float free, float herbs)
{
    float alone = free * (1.0 - smoothstep(0.1, 0.4, herbs));
    return (1.0 - crown.sward) * mix(alone, 1.0, smoothstep(0.25, 0.35, crown.radii_m.z));
}

/* How far from a crown's middle, east and north, its own leaves are no part of what the canopy's field tells, which
 * spreads each tree over the cells about it. */
float clear_of_crown_m(wd_crown crown)
{
    float clear_m = 0.0;
#ifdef CANOPY_LIGHT
    clear_m = min(1.25 / (push.canopy_scale.x * float(textureSize(CANOPY_LIGHT, 0).x)), 16.0);
#endif
    return max(1.1 * crown.radii_m.x, clear_m);
}

/* Whether it stands free, and each quarter of its sky where the crown is not before it. Low plants close over the
 * ground, of which that knows nothing. */
wd_alone crown_alone(wd_pixel pixel, wd_crown crown, vec4 skylit, wd_shelter shelter, wd_floor_sky on_floor, float free)
{
    float height_m = pixel.rel.z - crown.foot_z;
    vec2 center = crown.center_rel.xy + push.camera_m, corner = vec2(clear_of_crown_m(crown));
    vec4 field = vec4(canopy_light_near(center + corner, 0).xy, canopy_light_near(center - corner, 0).zw);
    vec4 high = vec4(canopy_light_near(center + corner, 2).xy, canopy_light_near(center - corner, 2).zw);
    vec4 low = vec4(canopy_light_near(center + corner, 3).xy, canopy_light_near(center - corner, 3).zw);
    wd_alone alone = NOT_ALONE;
    float herbs = through_herbs(herbs_above(shelter, height_m));
    vec4 floor_high = max(on_floor.level - LOW_OF_LEVEL * on_floor.low, 0.0) / (1.0 - LOW_OF_LEVEL);
    alone.beside = mix(field * field, on_floor.level, on_floor.share) * herbs;
    alone.high = mix(high * high, floor_high, on_floor.share) * herbs;
    alone.low = mix(low * low, on_floor.low, on_floor.share) * herbs;
    alone.share = free * crown.told;
    alone.outside = mix(1.0, eye_outside(crown, -pixel.direction), crown.told);
    alone.lets.xy = mix(vec2(pixel.openness), skylit.xy * wd_skylit_above(pixel.openness), alone.outside);
    alone.lets.zw = skylit.zw * wd_skylit_below(pixel.openness);
    alone.leaf = pixel.material >= WD_MATERIAL_LEAF ? is_tree(crown) : 0.0;
    float base_m = max(crown.center_rel.z - crown.radii_m.z - crown.foot_z, 0.1);
    float below = mix(1.0, 1.0 - smoothstep(0.5 * base_m, base_m, height_m), is_tree(crown));
    alone.beneath = below * (1.0 - alone.leaf);
    alone.edge = edge_of(pixel, shelter, on_floor) * alone.beneath;
    return alone;
}

/* Mean albedo of the forest's leaves, both sides of them. */
vec3 leaves_albedo()
{
    vec3 absorbed = frame.leaf_scatter * frame.leaf_scatter;
    return (1.0 - absorbed) / (1.0 - WD_RECOLLISION * absorbed);
}

/* A window of discs lacks the leaves right before those that it shows. Of leaves that lie flatter (mean |z| of their faces)
 * than those of birches and pines, these would hide just the ones that the sun reaches least. By path-traced beeches, oaks
 * and maples of 128 px under the sun alone. */
const float FLAT_FROM = 0.55, FLAT_LEAVES = 1.04;

/* Of a tree that stands free, an eye from above sees discs that lie deeper among its leaves than the leaves it would
 * see, one against the light some that others would leave less of the sun: factors on each disc's share of it, on the
 * mean by depth, which is too much under a high sun and too little against the light, and on the sky's. By path-traced
 * rows of six species at 32 and 128 px, from 4 and 40 degrees above, under five suns 15 to 60 degrees high. */
vec3 free_disc_light(vec3 eye, wd_crown crown, wd_lit_leaves model)
{
    float from_above = smoothstep(0.1, 0.6, eye.z), with_light = smoothstep(-0.1, 0.5, dot(eye, frame.sun_direction));
    float flatter = max(unpackHalf2x16(model.rough_flat).y - FLAT_FROM, 0.0);
    float each = mix(1.0, 1.07, from_above) * mix(0.95, 1.01, with_light) * (1.0 + FLAT_LEAVES * flatter);
    float by_depth = mix(1.05, 0.975, smoothstep(0.25, 0.95, frame.sun_direction.z)) * mix(1.06, 0.99, with_light);
    return mix(vec3(1.0), vec3(each, by_depth, mix(1.0, 1.03, from_above)), is_tree(crown));
}

bool is_disc(wd_pixel pixel)
{
    return pixel.lit > 0.0 && pixel.lit < 1.0;
}

bool is_level_picture(wd_pixel pixel)
{
    return pixel.material == WD_MATERIAL_CARD && push.level_cards != 0u;
}

bool is_reduced(wd_pixel pixel)
{
    return pixel.material == WD_MATERIAL_LEAF && pixel.lit < 0.0 && push.level_cards != 0u;
}

/* Of its neighbours' leaves over a place, this power of their share hides the sky there. By path-traced stands of
 * five species, 5 and 8 m apart, under an even sky. */
const float NEIGHBOURS_OVER = 0.75;

/* Leaves of dense crowns hide more of the sky overhead than of that at the horizon, which a clear one is bright at, those
 * of open ones less (low_sky of each model): by how much brighter an upright face's is than an even sky's. So much more of
 * clouds of leaves, whose mean normal alone is known; by path-traced oaks, spruces and birches. */
const float LOW_SKY_CLOUD = 0.11;

/* And of discs. By path-traced rows of oaks, birches, spruces and pines at 8 to 128 px, under clouds and a clear sky. */
const float LOW_SKY_DISCS = 0.25;

/* Between slender crowns of a stand an eye looks down to their lower parts, which one place for all of a card does not
 * tell: share of the sky's light. By path-traced stands of spruces, birches and pines under clouds. */
const float SLENDER_SKY = 0.88;

float brighter_low_sky()
{
    float level = frame.sky_form[0].y + frame.sky_form[3].y + frame.sky_form[6].y;
    return 2.0 * frame.sky_form[0].y / max(level, 1e-12) - 1.0;
}

/* What is so many times as bright as the leaves of a plant in flower is a petal. */
const float PETALS_BRIGHTER = 1.5;

bool is_petal(wd_pixel pixel, wd_lit_leaves model)
{
    float leaf = abs(unpackHalf2x16(model.base_petals).y);
    return leaf > 0.0 && pixel.snow == 0.0 && pixel.material >= WD_MATERIAL_LEAF
           && max(max(pixel.albedo.r, pixel.albedo.g), pixel.albedo.b) >= PETALS_BRIGHTER * leaf;
}

/* Albedo of the leaves about a petal: the model's own green, in the colour of the forest's. */
vec3 leaf_by_petal(wd_lit_leaves model)
{
    vec3 mean = leaves_albedo();
    return mean * (abs(unpackHalf2x16(model.base_petals).y) / max(mean.g, 1e-3));
}

/* So much of what scatters light to a petal of a flower are other petals; to one of a plume leaves do. By path-traced
 * camellias of 128 px and plumes of catalpas close by, 27 and 75 % too bright while all of it were petals. */
const float PETALS_BY_PETALS = 0.15;

vec3 scatters_to_petal(vec3 petal, wd_lit_leaves model)
{
    float petals = unpackHalf2x16(model.base_petals).y > 0.0 ? PETALS_BY_PETALS : 0.0;
    return mix(leaf_by_petal(model) * (1.0 + leaf_transmittance(model)), petal, petals);
}

/* The model's table holds in stands, too, past what neighbours leave, where an eye looks down on single leaves. A
 * low one sees what lies under others: the table's light would be a fifth too much there, and of a tree that stands
 * free as much is hidden as of the ground beside it. */
void light_past_neighbours(inout wd_alone alone, wd_pixel pixel, wd_crown crown, wd_lit_leaves model,
                           wd_shelter shelter, wd_place place)
{
    bool one_leaf = ALL_SINGLE || pixel.lit >= 0.0;
    float over = pow(canopy_above(shelter.layer_m, place.rel.z - crown.foot_z), NEIGHBOURS_OVER);
    float from_above = smoothstep(0.15, 0.45, -pixel.direction.z) * (1.0 - shelter.within);
    from_above *= crown.told;
    float hidden = mix(1.0, over, from_above);
    alone.sides = exp2(hidden * log2(max(alone.beside, 1e-3)));
    alone.high = exp2(hidden * log2(max(alone.high, 1e-3)));
    alone.low = exp2(hidden * log2(max(alone.low, 1e-3)));
    alone.known = mix(alone.share, 1.0, from_above);
    vec4 side = eye_side(-pixel.direction, alone.outside);
    alone.side = mix(vec4(1.0), side, one_leaf ? alone.share : 0.0);
    float more_low = is_disc(pixel) ? LOW_SKY_DISCS * is_tree(crown) : one_leaf ? 0.0 : LOW_SKY_CLOUD;
    float low_sky = unpackHalf2x16(model.again_low).y + more_low;
    alone.lets.xy *= 1.0 + alone.share * low_sky * brighter_low_sky();
    alone.lets.xy *= is_disc(pixel) ? mix(1.0, free_disc_light(-pixel.direction, crown, model).z, alone.share) : 1.0;
    alone.lets.xy *= one_leaf ? 1.0 : mix(1.0, SLENDER_SKY, slenderness(crown) * (alone.known - alone.share));
    know_neighbours(alone, past_neighbours(pixel.surface - 1u, crown, place.rel, side, pixel.openness), crown.told,
                    through_herbs(herbs_above(shelter, place.rel.z - crown.foot_z)));
    alone.lets.xy *= is_reduced(pixel) ? mix(1.0, reduced_light(-pixel.direction, model).y, alone.share * is_tree(crown)) : 1.0;
    alone.lets.xy *= mix(1.0, sky_over_table(-pixel.direction.z, one_leaf), max(alone.share, alone.by_crown) * is_tree(crown));
    vec3 leaf = pixel.material >= WD_MATERIAL_LEAF ? pixel.albedo * (1.0 + place.transmittance) : leaves_albedo();
    leaf = is_petal(pixel, model) ? scatters_to_petal(leaf, model) : leaf;
    float within = is_tree(crown) * (1.0 - alone.beneath);
    alone.again = mix(vec3(1.0), scattered_on(leaf, model), within);
    alone.scattered = within * scattered_again(mix(leaf, pixel.albedo, pixel.snow), model, -pixel.direction);
}

/* Mean normal of the sides of leaves that the eye sees (wd_leaves_seen_up), and how far their z spread, squared. */
vec4 leaves_seen(vec3 eye)
{
    float z = wd_leaves_seen_up(eye.z);
    return vec4(0.6 * eye.xy, z, max(0.45 - z * z, 0.0));
}

/* What a tree's own leaves leave of the sun, by depth in the crown, behind which the map is then asked. What is left to
 * places of a model that has tables is known (wd_crown_lit), with a factor of the model's own; of herbs depth alone says
 * it. */
void shade_by_crown(inout wd_place place, wd_crown crown, vec2 curve, float openness, float free,
                    float factor, uint cascade)
{
    wd_crown_way way = crown_way(crown, place.rel);
    float path_m = way.ends_m - way.begins_m;
    float through = wd_crown_through(crown.radii_m, path_m, openness);
    place.about = mix(through, wd_crown_lit(through, curve.x, curve.y), crown.told);
    place.own = place.about * mix(1.0, factor, crown.told);
    float left_m = max(way.ends_m, crown_card_m(crown, place.rel)); /* all of the tree itself */
    place.ahead_m = mix(path_m, left_m, free) + cascade_numbers(cascade)[WD_CASCADE_TEXEL_M];
}

/* A map is asked past what is nearer to a leaf than about a texel, whose shade is known of its model (tree/sunlit.h), and
 * lets light past the edges of what hides the sun, more of which a low eye sees: per metre of texels, by path-traced rows
 * of eight species with texels of 2 to 6 cm. Of the sun that the map lets through, what is left. */
const vec2 MAP_EDGES_PER_M = vec2(2.0, 0.65);

float near_shade(wd_lit_leaves model, vec3 eye, uint cascade)
{
    vec2 near = unpackHalf2x16(model.near_shade);
    float texel_m = cascade_numbers(cascade)[WD_CASCADE_TEXEL_M];
    float edges = mix(MAP_EDGES_PER_M.x, MAP_EDGES_PER_M.y, smoothstep(0.1, 0.6, eye.z)) * texel_m;
    return 1.0 / (1.0 + edges + near.x * pow(min(texel_m * (1.0 / WD_NEAR_SHADE_M), 2.0), near.y));
}

/* `mapped` of their shade is in the shadow map, which holds leaves as far as `fine` says and lets so much through. */
void shade_by_map(inout wd_place place, float mapped, float fine, float lets)
{
    place.own = mix(place.own, lets, mapped * fine);
    place.ahead_m *= 1.0 - fine;
}

/* What the wax of one leaf mirrors of the sun, over a lit wall. */
float leaf_coat(vec3 normal, vec3 eye, float roughness)
{
    float toward_eye = max(dot(normal, eye), 0.05), lit = dot(normal, frame.sun_direction);
    vec3 half_way = normalize(eye + frame.sun_direction);
    float alpha = roughness * roughness;
    return lit <= 0.0 ? 0.0 : wd_wax_mirrors(toward_eye, lit, dot(normal, half_way), dot(half_way, eye), alpha * alpha);
}

/* What the wax of one leaf mirrors of even light about the mirrored ray: GGX's facets, and the more the
 * flatter they are seen; fitted to their integral for roughnesses of 0.35 to 0.62, within 0.01. */
float leaf_coat_around(float toward_eye, float roughness)
{
    float flat_on = exp2(0.294 - 5.41 * roughness - toward_eye * (3.46 + 6.49 * toward_eye));
    return WD_WAX * (1.1 - 0.45 * roughness) + flat_on;
}

/* How much of a disc's shade the map is left to tell: its look-up leaves out the leaves next to the place. By
 * path-traced stands of oaks, from within and from above. */
const float MAP_TELLS = 0.5;

/* Needles and leaves of a spray stand closer than a map's texels, which then hold others than the one that is
 * seen: of those about as far toward the sun as it is, half would shade it. Nearer than this nothing does where
 * the eye tells them from one another; of broad leaves it sees how they shade each other from close by, too. By
 * path-traced sprays of spruce and beech 9 m off and by the gallery's leaves. */
const float NEEDLES_AHEAD_M = 0.03;

/* From within the darkest stands an eye sees, past discs, some that lie higher in their crowns, under more of the sun
 * and the sky, than the leaves that it would see: share of their light that these have, the sun's and the sky's. By
 * path-traced crowns of three stands, one of them so dark. */
const vec2 PAST_DISCS = vec2(0.87, 0.74);

/* Log2 of one over the sky's share on the floor of stands where none of that counts, and all. */
const vec2 PAST_DISCS_FROM = vec2(2.9, 3.9);

vec2 past_discs(wd_pixel pixel, wd_shelter shelter, wd_alone alone)
{
    float stand = is_disc(pixel) ? shelter.within * (1.0 - alone.share) : 0.0;
    float darkest = smoothstep(PAST_DISCS_FROM.x, PAST_DISCS_FROM.y, -log2(shelter.floor_mean));
    return mix(vec2(1.0), PAST_DISCS, stand * darkest);
}

/* Where trees show so many discs or fewer, a pixel's share of the sun is the mean that its depth in the crown leaves,
 * which samples need not find; where they show so many or more, each disc's own. Of trees that stand free
 * with leaves that lie flatter than those of birches and pines few discs are lit by up to a quarter too much, each by
 * itself, up to so many times as many (path-traced oaks of 64 px). */
const float FEW_DISCS = 100.0, MANY_DISCS = 400.0, FREE_DISCS = 4.0;

/* In stands, where crowns reach into one another, the map is asked from so far on of the way out of the own one, and
 * tells some of its shade again: factors on each disc's own share of the sun and on the mean. Where there is no map, a
 * stand's cover stands for the shade that these make up for. By path-traced stands of bench75k and of beeches. */
const float STAND_WAY = 0.4, STAND_NO_MAP = 1.20;
const vec2 STAND_DISC_SUN = vec2(1.12, 1.02);

/* What of the sun a disc's own tree leaves it: what is known of ways through that. `sun`: factors on each disc's share
 * and on the mean by depth. A map that holds leaves tells more where discs are as near as they are; a disc may lie a
 * pixel behind its leaf then. Leaves of meshes (lit 1) are in the nearest maps as they are. 0: none goes on to the eye. */
void shade_disc(inout wd_place place, wd_pixel pixel, wd_crown crown, wd_lit_leaves model, float free, vec2 sun,
                uint cascade)
{
    float pixel_m = pixel_size_m(pixel);
    if (!is_disc(pixel)) {
        float told = map_tells_leaves(cascade, crown.sward);
        float broad = smoothstep(0.4, 0.8, place.transmittance.y); /* needles let little through */
        float apart = (1.0 - smoothstep(0.015, 0.05, pixel_m)) * mix(1.0, smoothstep(0.002, 0.006, pixel_m), broad);
        float needles_m = NEEDLES_AHEAD_M * told * apart, held = mix(map_holds_mesh(cascade), told, crown.sward);
        place.own = pixel.lit <= 0.0 ? 0.0 : mix(place.own, near_shade(model, -pixel.direction, cascade), held);
        place.ahead_m = mix(place.ahead_m, needles_m, held);
        return;
    }
    vec2 curve = unpackHalf2x16(model.sun_curve);
    float tall_m = crown.center_rel.z + crown.radii_m.z - crown.foot_z;
    float texel_m = cascade_numbers(cascade)[WD_CASCADE_TEXEL_M];
    float discs = 0.6 * crown.radii_m.x * tall_m / (pixel_m * pixel_m); /* about as many */
    float known = wd_disc_close(discs) * map_holds_leaves(cascade, 1.0);
    float path_m = wd_crown_path_m(place.rel - crown.center_rel, crown.radii_m, frame.sun_direction);
    float mean = wd_crown_lit(wd_crown_through(crown.radii_m, path_m, pixel.openness), curve.x, curve.y);
    float lies_flat = smoothstep(FLAT_FROM, FLAT_FROM + 0.08, unpackHalf2x16(model.rough_flat).y);
    float few = discs / mix(1.0, FREE_DISCS, free * lies_flat);
    float singly = mix(1.0, smoothstep(FEW_DISCS, MANY_DISCS, few), is_tree(crown));
    float lit = mix(mean * sun.y, pixel.lit * sun.x, singly);
    /* its own tree is in `lit`; shrubs are not much wider than half a metre */
    float tree_m = is_tree(crown) * min(0.5, 0.25 * crown.radii_m.x);
    float ahead_m = place.ahead_m * (cascade < WD_LEAF_CASCADES ? mix(STAND_WAY, 1.0, free) : 1.0) + tree_m + texel_m;
    place.own = mix(lit, 1.0, known * mix(MAP_TELLS, 1.0, crown.sward));
    place.ahead_m = mix(ahead_m, pixel_m, known);
}

/* A leaf that an eye below sees from the side that the sun reaches is tilted from both: others next to it, and its own
 * folds and arch, which neither maps nor its tree's ways tell, leave it less of the sun, the least against the light. By
 * path-traced oaks, beeches, birches and spruces whose upper sides alone reflect; meshes, half of it, by stands from
 * within. Snow lies over folds and is lit as it is. */
float lit_side_from_below(wd_pixel pixel, wd_crown crown)
{
    vec3 eye = -pixel.direction;
    float of_mesh = pixel.lit >= 1.0 ? 1.0 : 0.0;
    float below = (1.0 - smoothstep(-0.3, 0.0, eye.z)) * is_tree(crown) * (1.0 - 0.5 * of_mesh);
    float with_light = smoothstep(-0.7, 0.5, dot(eye, frame.sun_direction));
    return mix(1.0, mix(0.38, 0.66, with_light), below * (1.0 - pixel.snow));
}

/* A disc of a leaf is lit as the leaf that it is. */
void light_disc(inout wd_place place, wd_pixel pixel, wd_crown crown, wd_lit_leaves model, float free, vec2 sun,
                uint cascade)
{
    if (!ALL_SINGLE && pixel.lit < 0.0)
        return;
    shade_disc(place, pixel, crown, model, free, sun, cascade);
    place.normal = pixel.normal;
    place.cloud = 0.0;
    float cosine = dot(pixel.normal, frame.sun_direction);
    float from_below = lit_side_from_below(pixel, crown);
    place.sides = vec2(max(cosine, 0.0) * from_below, max(-cosine, 0.0));
    place.waxed = pixel.above;
    place.body = 1.0 - pixel.above * (1.0 - crown.sward) * wd_grazing(abs(dot(pixel.normal, pixel.direction)));
    place.gloss = leaf_coat(pixel.normal, -pixel.direction, leaf_roughness(model)) * pixel.above * from_below;
    place.coat = leaf_coat_around(abs(dot(pixel.normal, pixel.direction)), leaf_roughness(model));
}

/* A pixel of many leaves has the mean colour of the sides that are seen: of these, upper ones, which are less pale, reflect
 * most of what comes from above. By the albedo of a lower side goes what it lets through, too, less the more it is the
 * paler in green (look maps). */
void tell_sides(inout wd_place place, wd_pixel pixel, wd_lit_leaves model, wd_upper_sides upper)
{
    upper.seen = mix(upper.seen, BLADES_BEND, place.sward);
    upper.reflect = mix(upper.reflect, BLADES_LIT, place.sward);
    upper.sky = mix(upper.sky, BLADES_LIT, place.sward);
    vec3 paler = paler_below(model);
    float through_below = 1.0 / max(paler.g, 1e-3);
    place.reflects = place.reflects_sky = vec3(1.0);
    place.waxed_lit = vec2(place.waxed);
    if (!ALL_SINGLE && pixel.lit < 0.0) {
        bool level = is_level_picture(pixel);
        bool any_way = (model.paler & WD_PALER_ANY_WAY) != 0u;
        place.waxed = any_way ? 0.5 : place.waxed;
        place.coat = upper.sky_mirrors / place.waxed;
        vec3 all = 1.0 / mix(paler, vec3(1.0), level ? upper.level : upper.seen);
        place.reflects = mix(paler, vec3(1.0), upper.reflect) * all;
        place.reflects_sky = mix(paler, vec3(1.0), upper.sky) * all;
        place.transmittance *= mix(paler * through_below, vec3(1.0), upper.transmit) * all;
        place.waxed_lit = vec2(upper.reflect, upper.sky);
    } else {
        place.transmittance *= mix(through_below, 1.0, place.waxed);
    }
}

/* Petals have no wax, and let through what leaves do, not more for being paler (look maps). */
void know_petals(inout wd_place place, wd_pixel pixel, wd_lit_leaves model)
{
    if (!is_petal(pixel, model))
        return;
    place.transmittance = leaf_transmittance(model) * leaf_by_petal(model) / max(pixel.albedo, 1e-3);
    place.waxed = place.gloss = 0.0;
    place.waxed_lit = vec2(0.0);
    place.body = 1.0;
}

/* Wood within a crown is in its shade as leaves are. Where a pixel shows branches that lie this way and that, which its
 * short mean normal tells, those of a tree that stands free are lit as its table says, by maps that are not as fine as
 * leaves. */
wd_place wood_place(wd_pixel pixel, wd_crown crown, vec2 curve, float free, vec2 sunlit, uint cascade)
{
    wd_place place = ground_place(pixel);
    float branches = pixel.lit < 0.0 ? 1.0 - smoothstep(0.8, 1.0, length(pixel.facing)) : 0.0;
    float fine = mix(map_holds_leaves(cascade, free), map_tells_leaves(cascade, 0.0), free * branches);
    float many = branches * (1.0 - fine);
    shade_by_crown(place, crown, curve, pixel.openness, free, mix(sunlit.x, 1.0, many), cascade);
    place.sides.x = mix(place.sides.x, sunlit.y, many * free);
    place.own = pixel.lit < 0.0 ? place.own : pixel.lit;
    place.bulges = 1.0;
    shade_by_map(place, pixel.lit < 0.0 ? 1.0 : 0.0, fine, 1.0);
    return place;
}

/* Leaves of herbs lie in one another's shade and flat, where those of crowns lie every way: so much of what the wax
 * of many would mirror goes on to the eye, of the sky, and of the sun where no table tells it. By path-traced ferns and
 * tufts that stand free. */
const float HERB_SHINES = 0.4;

/* Leaves of reduced meshes stand for several: how far maps that hold them light each as the leaf that it is. By path-traced
 * trees of four species close by. */
const float MESH_SINGLE = 0.6;

/* Where a pixel of a tree that stands free is so wide, a reduced mesh's few leaves in the maps shade one another less than
 * those that it stands for, and its table alone lights it. By path-traced oaks and birches at 128 px and hazels at 32,
 * which were up to 19 and 48 % too bright. So does that of a shrub, from pixels on that are as wide beside it as these are
 * beside a tree of MESH_MAPPED_TREE_M: by brambles and camellias at 128 px, which were up to 20 % too dark. */
const vec2 MESH_MAPPED_M = vec2(0.05, 0.15);
const float MESH_MAPPED_TREE_M = 20.0;

/* How far shadow maps hold leaves as they are seen. Of a z-field that stands free, the table alone lights leaves: maps hold
 * others than it shows. By path-traced rows of seven species at 32 and 128 px, which were up to 14 % too bright and of hazel
 * from -18 to +31 %. */
float leaves_in_maps(wd_pixel pixel, wd_crown crown, float free, uint cascade)
{
    bool disc = pixel.lit >= 0.0 && pixel.lit < 1.0;
    if (pixel.material == WD_MATERIAL_CARD || disc)
        return 0.0;
    bool pictured = pixel.lit < 0.0 && push.level_cards == 0u; /* a z-field's */
    float height_m = crown.center_rel.z + crown.radii_m.z - crown.foot_z;
    float shrub = smoothstep(0.34, 0.42, crown.radii_m.z) * (1.0 - smoothstep(5.0, 9.0, height_m));
    float lower = mix(1.0, MESH_MAPPED_TREE_M / height_m, shrub);
    float wide = smoothstep(MESH_MAPPED_M.x, MESH_MAPPED_M.y, lower * pixel_size_m(pixel));
    return map_holds_leaves(cascade, free) * (1.0 - free * (is_reduced(pixel) ? wide : pictured ? 1.0 : 0.0));
}

/* How far a pixel's normal is one leaf's. */
float leaf_is_plain(wd_pixel pixel, wd_crown crown, float fine)
{
    float plain = pixel.material == WD_MATERIAL_CARD ? 0.0 : 1.0 - smoothstep(4.0, 20.0, pixel.axis_m);
    return max(plain, is_reduced(pixel) ? MESH_SINGLE * fine * is_tree(crown) : 0.0);
}

/* What wax mirrors, of the sun and of the sky. */
void shine(inout wd_place place, inout wd_upper_sides upper, wd_pixel pixel, wd_crown crown, wd_lit_leaves model, float near)
{
    float cosine = dot(-pixel.direction, frame.sun_direction);
    place.waxed = mix(0.5 - 0.5 * pixel.direction.z, BLADES_BEND, place.sward);
    place.body = 1.0 - WAX_CLOUD * place.waxed * (1.0 - place.sward);
    float shines = mix(HERB_SHINES, 1.0, max(is_tree(crown), place.sward));
    upper.sky_mirrors *= shines;
    place.gloss = leaf_gloss(pixel, leaf_roughness(model), near) + WD_WAX * 0.39;
    place.gloss = (shines * place.gloss + 0.25 * place.sward * wax_ahead(cosine)) * place.waxed;
    vec2 wax = unpackHalf2x16(model.cloud_wax);
    float mirrors = WD_WAX * shines * upper.mirrors * (wax.x + wax.y * wd_cloud_wax_rise(cosine));
    place.gloss = mix(place.gloss, mirrors * (place.sides.x + place.sides.y), crown.told);
}

/* Near, the maps hold each leaf and the crown's depth adds little. Far, the crown is left behind before the
 * map is asked, and depth along the sun says where in it how much of the light is left. Of a tree that stands
 * free the model's own table says how much of that on all of it goes to this eye: of a cloud of leaves
 * (cards, and meshes of few that stand for many), or of leaves that are lit one by one. */
wd_place leaf_place(wd_pixel pixel, wd_crown crown, wd_lit_leaves model, wd_upper_sides upper, float free,
                    vec2 sunlit, float hot, uint cascade)
{
    bool card = pixel.material == WD_MATERIAL_CARD, reduced = is_reduced(pixel), disc = pixel.lit >= 0.0 && pixel.lit < 1.0;
    vec3 eye = -pixel.direction;
    float near = card ? 0.25 : mix(0.8, 0.3, clamp(pixel.axis_m / 120.0, 0.0, 1.0));
    float fine = leaves_in_maps(pixel, crown, free, cascade), plain = leaf_is_plain(pixel, crown, fine);
    float mapped = fine * mix(0.75, 1.0, is_tree(crown));
    wd_place place;
    place.bulges = 0.0;
    place.rel = card ? crown_card_place(crown, pixel.direction) : pixel.rel;
    place.sward = crown.sward;
    shade_by_crown(place, crown, unpackHalf2x16(model.sun_curve), pixel.openness, free,
                   pixel.lit >= 1.0 ? sunlit.x : 1.0, cascade);
    place.own *= mix(1.0, card ? sward_tufts_lit() : 1.0, place.sward);
    shade_by_map(place, mix(0.75 - 0.375 * place.sward, 1.0, is_tree(crown)), fine, near_shade(model, eye, cascade));
    vec2 even = leaf_cloud(dot(eye, frame.sun_direction));
    vec2 blades = mix(even, leaf_blade(pixel.facing, eye, plain), max(near, plain));
    float deeper = reduced ? mix(1.0, reduced_light(eye, model).x, free * is_tree(crown)) : 1.0;
    vec2 known = sunlit * (deeper * mix(stand_sunlit(eye, crown, model, upper.open), 1.0, free));
    place.sides = mix(mix(blades * herbs_sunlit(eye), known, crown.told), blades, mapped);
    place.transmittance = leaf_transmittance(model);
    vec2 blade_light = sward_light(disc ? pixel_size_m(pixel) : 0.0, 2.0 * crown.radii_m.z, eye);
    place.sky = pixel.lit >= 0.0 ? mix(1.0, blade_light.y, place.sward) : 1.0;
    place.over = wd_crown_per_m(crown.radii_m) /* of cards, which are flat: in the middle */
                 * (card ? crown.radii_m.z : sward_depth_m(crown, place.rel));
    shine(place, upper, pixel, crown, model, near);
    place.normal = normalize(mix(crown_normal(crown, place.rel), pixel.normal, 0.4 * near));
    place.cloud = 1.0;
    float sunny = dot(pixel.normal, frame.sun_direction) < 0.0 ? -1.0 : 1.0;
    float sheet = pixel.lit >= 1.0 ? 1.0 - smoothstep(0.008, 0.04, pixel_size_m(pixel)) : plain;
    place.sheet = fine > 0.0 ? sheet * sunny * pixel.normal : vec3(0.0);
    vec2 in_stands = mix(vec2(1.0), STAND_DISC_SUN, is_tree(crown));
    vec2 on_discs = vec2(hot, sunlit.x) * mix(in_stands, free_disc_light(eye, crown, model).xy, free);
    light_disc(place, pixel, crown, model, free, on_discs, cascade);
    place.own *= mix(1.0, blade_light.x, place.sward);
    tell_sides(place, pixel, model, upper);
    know_petals(place, pixel, model);
    return place;
}
