/* Light from everywhere: the sky's past stands, herbs and a tree's own crown, what leaves scatter and what comes
 * back from the ground.
 * Expects `frame`, `push` (wd_light_push) and the libraries of gbuffer and crown. */

#include "shared/crown_sky.h"

/* Of the canopy here (forest/canopy_light.h), in layer 0 the roots of the shares of the sky's light from
 * each quarter that reach the ground's herbs, past crowns and hills; in layer 1 those of its base and top,
 * and of the herbs. Where the shader does not say, all light does. */
#ifndef CANOPY_LIGHT_AT
#define CANOPY_LIGHT_AT(at, layer) vec4(1.0 - (layer))
#endif

/* Coordinates of a local place in it. */
vec2 canopy_at(vec2 place_m)
{
    return (place_m - push.canopy_from_m) * push.canopy_scale;
}

/* What comes down to a place among leaves. */
struct wd_shelter {
    vec4 through;     /* the share of the sky's quarters that no leaf stops */
    float floor_mean; /* the mean of that on the ground all about, as the canopy's field has it */
    float under;      /* log2 of the share that leaves of the stand over the place let down */
    float beside;     /* the same, of all leaves that lie higher: what a level way meets sooner */
    vec2 layer_m;     /* base and top of the stand's leaves over the ground */
    float herbs;      /* layers of herbs on the ground, */
    float herbs_m;    /* so high */
    float low;        /* 1: on the ground, whose light comes from right beside the place; 0: far over it */
    float floor_herbs; /* log2 of the share of light that herbs between leave the ground */
    float within;      /* 1: the eye is below the stand's tops, 0: over them */
    float snow;        /* share of the ground that lies under it */
};

/* Skylight past herbs that have so many layers over a place. Slanting rays meet more of them, but leaves let
 * some through: of path-traced ferns under clouds, the like of a steep ray past black ones. */
float through_herbs(float layers)
{
    return exp(-layers);
}

/* What crowns leave the ground about the eye (shared/crown_sky.h): shares of the quarters' light on level ground, and of
 * their low sky's. `share`: how far that is known. `stems`: what those beside the place leave of it. */
struct wd_floor_sky {
    float share;
    vec4 level, low;
    float stems;
};

const wd_floor_sky NO_FLOOR = wd_floor_sky(0.0, vec4(0.0), vec4(0.0), 1.0);

#ifdef CROWN_SKY
float stem_hides(uint stem, vec2 from_middle_m)
{
    vec2 apart_m = vec2(WD_STEM_EAST_M(stem), WD_STEM_NORTH_M(stem)) - from_middle_m;
    return stem != 0u ? wd_stem_hides(length(apart_m), WD_STEM_RADIUS_M(stem)) : 0.0;
}

/* Between four squares; the roots are mixed. */
wd_floor_sky floor_sky(vec3 rel)
{
    wd_floor_sky left = NO_FLOOR;
    left.share = clamp((1.0 - length(rel) / max(push.floor_sky_m, 0.1)) / (1.0 - WD_FLOOR_SKY_WHOLE), 0.0, 1.0);
    if (left.share <= 0.0)
        return left;
    vec2 at = (rel.xy + push.camera_m) * (1.0 / WD_FLOOR_SKY_M) - 0.5, low = floor(at);
    vec2 next = at - low, here = 1.0 - next;
    float hidden = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 on = ivec2(i & 1, i >> 1), square = ivec2(low) + on;
        vec2 shares = mix(here, next, vec2(on)), from_m = WD_FLOOR_SKY_M * (next - vec2(on));
        uvec4 texel = texelFetch(CROWN_SKY, int(wd_floor_sky_texel(square.x, square.y)));
        hidden = max(hidden, max(stem_hides(texel.z, from_m), stem_hides(texel.w, from_m)));
        left.level += shares.x * shares.y * unpackUnorm4x8(texel.x);
        left.low += shares.x * shares.y * unpackUnorm4x8(texel.y);
    }
    left.level *= left.level;
    left.low *= left.low;
    left.stems = 1.0 - hidden;
    return left;
}
#else
wd_floor_sky floor_sky(vec3 rel)
{
    return NO_FLOOR;
}
#endif

/* Of plants as far as they are herbs: what the field says of trees is not the ground's at their stems. */
wd_floor_sky herbs_floor_sky(wd_crown crown, vec3 rel)
{
    float herb = 1.0 - is_tree(crown);
    wd_floor_sky on_floor = NO_FLOOR;
    if (herb > 0.0)
        on_floor = floor_sky(rel);
    on_floor.share *= herb;
    return on_floor;
}

wd_shelter ground_shelter(wd_pixel pixel)
{
    vec4 field = CANOPY_LIGHT_AT(canopy_at(pixel.rel.xy + push.camera_m), 0.0);
    vec4 layers = CANOPY_LIGHT_AT(canopy_at(pixel.rel.xy + push.camera_m), 1.0);
    wd_shelter shelter;
    shelter.layer_m = WD_CANOPY_MOST_M * layers.xy * layers.xy;
    shelter.herbs = WD_HERBS_MOST * layers.z * layers.z;
    shelter.herbs_m = WD_HERB_M * layers.w * layers.w;
    shelter.low = 0.0;
    shelter.floor_herbs = 0.0;
    shelter.within = 0.0;
    shelter.snow = wd_snow_mean(pixel.rel.z + float(frame.camera_mm[2]) * 0.001);
    shelter.through = max(field * field, vec4(1e-3));
    shelter.floor_mean = dot(shelter.through, vec4(0.25));
    shelter.under = shelter.beside = log2(shelter.floor_mean);
    shelter.through *= pixel.surface == 0u ? pixel.openness * through_herbs(shelter.herbs) : 1.0;
    return shelter;
}

/* The same where the table tells of the place itself what the field does of all about it: of the ground and herbs.
 * `own`: share of the place's own openness and herbs. */
wd_shelter floor_shelter(wd_shelter shelter, wd_floor_sky on_floor, float own)
{
    vec4 level = max(on_floor.level, vec4(1e-3));
    shelter.through = mix(shelter.through, level * own, on_floor.share);
    shelter.under = log2(mix(shelter.floor_mean, dot(level, vec4(0.25)), on_floor.share));
    return shelter;
}

#include "lib/canopy_above.glsl"

/* Layers of herbs over a height: their leaves are spread evenly over theirs. */
float herbs_above(wd_shelter shelter, float height_m)
{
    return shelter.herbs * clamp(1.0 - height_m / max(shelter.herbs_m, 0.01), 0.0, 1.0);
}

/* An eye within a stand sees those leaves of a place that lie under the others there: by so many more of their
 * tree's own, looking down and looking up. By path-traced oaks and beeches, and three stands from within. */
const float BELOW_LEAVES = 0.26, BELOW_LEAVES_UP = 0.08;

/* The ground right beside a stem's foot is in the sun or not as the foot is, but a metre off it may be otherwise: how far
 * the foot tells. With all of it feet in shade lacked the red that lit litter throws back (path-traced stems of
 * scenes/bench75k.json, `walk`). */
const float FLOOR_BESIDE = 0.75;

/* `direction_z`: of the way from the eye. */
float looks_up(float direction_z)
{
    return smoothstep(-0.2, 0.2, direction_z);
}

/* On a tree: what its own leaves let through, and of what the stand lets down to the ground as much as
 * there are leaves of it higher up: what of it is above the whole tree, and neighbours beside it. The
 * ground's own share is that of gaps between crowns, in which no leaf is. Herbs get what the ground
 * gets, less what their own take. */
wd_shelter tree_shelter(wd_pixel pixel, vec3 rel, wd_crown crown, wd_shelter shelter)
{
    float top_m = crown.center_rel.z + crown.radii_m.z - crown.foot_z;
    float above = canopy_above(shelter.layer_m, rel.z - crown.foot_z);
    float higher = canopy_above(shelter.layer_m, top_m);
    float herb = 1.0 - is_tree(crown);
    float over = crown.sward * wd_crown_per_m(crown.radii_m) * sward_depth_m(crown, pixel.rel);
    shelter.within = 1.0 - smoothstep(0.5, 1.0, -crown.foot_z / max(shelter.layer_m.y, 1.0));
    float below = mix(BELOW_LEAVES, BELOW_LEAVES_UP, looks_up(pixel.direction.z));
    float own = pow(max(pixel.openness, 1e-2), 1.0 + below * shelter.within * (1.0 - herb));
    float under = mix(higher, 1.0, above);
    vec4 stand = own * exp2(under * log2(shelter.through));
    shelter.through = mix(stand, shelter.through * own * exp(-0.7 * over), herb);
    shelter.through *= through_herbs(herbs_above(shelter, rel.z - crown.foot_z));
    shelter.low = FLOOR_BESIDE * exp2(min(crown.foot_z - pixel.rel.z, 0.0));
    shelter.floor_herbs = log2(through_herbs(shelter.herbs));
    shelter.under *= mix(under, 1.0, herb);
    shelter.beside *= mix(sqrt(above), 1.0, herb);
    return shelter;
}

/* Irradiance of a sky's form on a surface is even + odd, on its other side even - odd. */
#define SKY_ODD(form, n) (form[1] * n.x + form[2] * n.y + form[3] * n.z)
#define SKY_EVEN(form, n)                                                                          \
    (form[0] + form[4] * (n.x * n.y) + form[5] * (n.y * n.z) + form[6] * (n.z * n.z)               \
     + form[7] * (n.x * n.z) + form[8] * (n.x * n.x - n.y * n.y))

/* The same, of level skies: without what differs between quarters beyond toward and away. */
#define SKY_LEVELS(form, n) (form[0] + form[6] * (n.z * n.z) + SKY_ODD(form, n))

/* Where a stand lets down 0.115 of an even sky's light, its rays come from as steep as in sky_under: one
 * over the log2. Path-traced stems in a closed forest under clouds get 0.24 of what the ground does. In darker
 * stands it comes more steeply still, at most by so much: by four stems of scenes/bench75k.json, `walk`. */
const float UNDER_PER_LOG2 = -0.32, UNDER_MOST = 1.5;

/* Irradiance of a surface and of its other side. Leaves scatter a share of what they stop, so that a
 * stand which lets t through if leaves were black lets t^s through, s the root of the share of light
 * that they absorb (Goudriaan 1977, sections 2.3 and 2.4; de Pury and Farquhar 1997); a deep canopy
 * returns (1 - s) / (1 + s). So all but the sun's own rays is had from the sky's share: a ray of the sun
 * meets b times as many leaves as that of the mean of the sky's, cos(48 degrees). What leaves scatter
 * of it downward, 1 - s, comes from where the ray met them as light from everywhere: of a depth that
 * lets t through, (1 - s) b ln(1 / t) times the mean over its way of t^s below and t^b above, their
 * logarithmic mean, within some percent (Carlson 1972). A low sun lights but the tops so; t^(s b), what
 * the ray would bring along its own way, is next to nothing there. */
struct wd_around {
    vec3 front, back;
    vec3 mirrored; /* over pi: what comes along `mirror` from beyond the tree */
};

/* The sky about the sun lies wide beside stems and far crowns, whose shadows it fills, but is hidden by the
 * leaves close to a leaf that hide the sun: how far. Of a hill that hides the sun it is in part above. */
const float NEAR_SUN = 0.7, NEAR_SUN_BLADES = 0.92, OVER_HILLS = 0.6;

/* Ways past a stand to the sky about the sun, most of which lies higher than a low sun, over the mean way of the
 * sky's light: the one over the sine and the other. By path-traced stands under suns of 12 to 60 degrees. */
const float WIDE_WAY = 0.9, WIDE_HIGHER = 0.355;

/* 0 of stands that leave a sixth of the sky and more, 1 of those that leave a sixteenth. */
float darkest_stand(wd_shelter shelter)
{
    return smoothstep(2.5, 4.0, -log2(shelter.floor_mean));
}

/* Of such dark stands, gaps are few and steep, and ways from their floor to a low sun
 * meet more yet: by so much, by path-traced floors of scenes/bench75k.json. */
float floor_way(wd_shelter shelter)
{
    return 1.0 + 0.3 * darkest_stand(shelter);
}

/* The sun's own and that of the sky about it, on a surface that faces it. */
vec3 sunlight()
{
    return frame.sun_irradiance + frame.circumsolar;
}

/* Irradiance of level ground that has these shares of the sky's quarters. */
vec3 sky_level(vec4 through)
{
    return frame.sky_quarters[0] * through.x + frame.sky_quarters[1] * through.y
           + frame.sky_quarters[2] * through.z + frame.sky_quarters[3] * through.w;
}

vec4 quarters_bright()
{
    return vec4(frame.sky_quarters[0].y, frame.sky_quarters[1].y, frame.sky_quarters[2].y,
                frame.sky_quarters[3].y);
}

/* How much of the light of each quarter (east, north, west, south) a face has that looks this way. */
vec4 faced_quarters(vec2 n)
{
    return 0.5 + 0.5 * vec4(n, -n);
}

/* A crown stands before the quarters behind it, and what an eye `outside` it sees of it looks out toward the eye: by how
 * much that lets it have of the quarters. Fitted to path-traced oaks and spruces under skies of one bright side. */
const float OWN_SIDE = 0.7;

vec4 eye_side(vec3 eye, float outside)
{
    vec2 level = OWN_SIDE * outside * eye.xy * inversesqrt(max(dot(eye.xy, eye.xy), 0.25));
    return 1.0 + vec4(level, -level);
}

/* Share of its sky's light that a face has that an eye sees, of what it would have if the sky were as bright on
 * all sides. */
float sky_of_side(vec4 side, vec4 bright, vec4 faced)
{
    float even = dot(side, faced) / max(dot(faced, vec4(1.0)), 1e-12);
    return dot(side, bright * faced) / max(even * dot(bright, faced), 1e-12);
}

/* Within an even stand a face looking out level has of its low sky's light about the square of what the ground has
 * of the sky's. What it has beyond that comes in below crowns, from where the stand ends. */
vec4 past_edge(vec4 low, vec4 level)
{
    return max(low - level * level, 0.0) * (1.0 - level);
}

/* Of a place on the ground or beneath crowns. `shelter`: the ground's. */
vec4 edge_of(wd_pixel pixel, wd_shelter shelter, wd_floor_sky on_floor)
{
    vec4 low = CANOPY_LIGHT_AT(canopy_at(pixel.rel.xy + push.camera_m), 3.0);
    return past_edge(mix(low * low, on_floor.low, on_floor.share), shelter.through);
}

/* Mean of the quarters' shares by how much light each has. */
float by_light(vec4 shares, vec4 light)
{
    return dot(shares, light) / max(dot(light, vec4(1.0)), 1e-12);
}

/* Of what level ground has of an even sky so much comes from below 30 degrees; of any sky what both this and an upright
 * face's mean irradiance tell (low_share). */
const float LOW_OF_LEVEL = 0.25;

vec3 low_of_level(vec3 upright, vec3 level)
{
    return clamp(1.043 * upright - 0.272 * level, vec3(0.0), level);
}

/* Share of the sky about the sun that lies low, by the sun's sine: by the floor of a path-traced plot, 8 m in. */
float low_about_sun(float rise)
{
    return clamp(1.0 - 1.4 * rise, 0.0, 1.0);
}

/* Of a tree that stands free: low light comes in by its sides. What its own crown leaves is a table of its
 * model's (shared/sunlit.h). */
struct wd_alone {
    float share;  /* how far it stands free, */
    float known;  /* and how far that table tells what of the sky it has */
    vec4 beside;  /* shares of the sky's quarters that the ground beside its crown has, */
    vec4 sides;   /* and the place past what stands there, */
    vec4 high, low; /* and an upright face there that looks that way, of its light from the high sky and the low */
    float outside;  /* see eye_outside */
    float by_crown; /* how far these two are of the tree's own table (lib/crown_sky.glsl) */
    vec4 side;    /* shares of what its own crown leaves that come from each quarter, over an even crown's */
    vec4 lets;    /* of light from above to the side that is seen and to the other, then from below */
    vec3 again;   /* times as much as without what its leaves scatter of that */
    vec3 scattered; /* irradiance of each side by what the crown's own leaves scatter of the sun */
    float leaf; /* 1: of a leaf of a crown; 0: of wood, herbs and the ground */
    float beneath; /* 1: of a stem beneath its crown's leaves, of herbs and the ground */
    vec4 edge;  /* shares of the quarters' low light that come in below crowns, from where the stand ends */
};

const wd_alone NOT_ALONE = wd_alone(0.0, 0.0, vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), 1.0, 0.0, vec4(1.0),
                                    vec4(0.0), vec3(1.0), vec3(0.0), 0.0, 1.0, vec4(0.0));

/* Of an even sky's light on an upright face so much comes from below 30 degrees, and of what level ground has a quarter:
 * what both have tells how much of any sky's does, of each colour. `upright`: irradiance of the face; `level`: of
 * level ground by such a half of the sky. */
vec3 low_share(vec3 upright, vec3 level)
{
    return clamp(1.272 - 0.663 * level / max(upright, vec3(1e-12)), 0.3, 0.95);
}

/* Share of its sky's light that a face has past what stands beside the place. `faced`: light of the quarters, by how
 * much of it the face has; `flat_on`: how level it is; `sky`: its irradiance in the open. */
vec3 sky_faced(wd_alone alone, vec4 faced, float flat_on, vec3 sky)
{
    float per_light = 1.0 / max(dot(faced, vec4(1.0)), 1e-12);
    float high = dot(alone.high, faced) * per_light, low = dot(alone.low, faced) * per_light;
    vec4 part = faced / max(quarters_bright(), vec4(1e-12));
    vec3 upright = mix(vec3(high), vec3(low), low_share(sky, sky_level(part)));
    return mix(upright, vec3(dot(alone.sides, faced) * per_light), flat_on);
}

/* Share of the sky about the sun that a tree's neighbours leave. */
float sky_about_sun(wd_alone alone)
{
    float up = smoothstep(0.3, 0.6, frame.sun_direction.z);
    return by_light(mix(alone.low, alone.high, up), frame.sunward);
}

/* The same of the sky in a direction. */
float sky_toward(wd_alone alone, vec3 direction)
{
    float up = max(direction.z, 0.0);
    vec4 quarters = mix(max(vec4(direction.xy, -direction.xy), vec4(0.0)), vec4(1.0), 0.05 + 0.95 * up * up);
    vec4 left = mix(alone.low, alone.high, smoothstep(0.2, 0.7, up));
    return by_light(left, quarters);
}

/* Of the ways past a stand to what a leaf of it mirrors, the leaves that they meet over those on the mean way of the
 * sky's light, times their sine: 0.67, as of any ray. Stands are leaves and gaps: of ways that meet t leaves on
 * average but now many and now few 1 / (1 + t) come through, not e^-t. By path-traced stands at 256 and 512 px a
 * tree, what wax adds to a picture is 0.88 to 1.19 of the traced. From within, below the crowns that it looks into,
 * an eye sees wax that mirrors these: 0.9 to 1.17 in three stands. */
const float ALONG = 0.67, ALONG_WITHIN = 1.5;

/* Leaves stand in crowns and light the insides of these first: of what they scatter of the sun far less comes down
 * a dark stand than through an even layer, but where they absorb little of it. Share that does where less than an
 * eighth of the sky is left, by path-traced floors and stems of three stands, one of them in autumn; and, of leaves that
 * absorb little, everywhere, by that one's floor in red, which is as bright as in blue now. */
const float AUTUMN_IN_CROWNS = 4.5;

vec3 out_of_crowns(vec3 scatter, float mean)
{
    vec3 dark = exp2(max(9.0 * scatter - 7.5, vec3(0.0)) * min(log2(mean) + 3.0, 0.0));
    vec3 again = 1.0 - scatter;
    return dark / (1.0 + AUTUMN_IN_CROWNS * again * again);
}

/* Leaves lie next to others of their crown, which send them more of what they scatter than an even layer would and
 * than stems get: of leaves that an eye below looks up to, so many times as much. By path-traced crowns of three
 * stands, one of them in autumn. */
const float NEXT_LEAVES = 1.8;

/* Light that comes back up from below a place in a crown goes with what that has of the sky: so much of it, by path-traced
 * leaves of scenes/bench75k.json at 512 px. */
const float OF_UPWARD = 0.5;

/* An eye over a stand that looks at it level sees its edge, whose upright faces have so much of what those of a gap have
 * over those within. By the path-traced overview of bench/light.json under clouds. */
const float OF_EDGE = 0.35;

/* Of the sun that a tree's own leaves scatter to one another, what a stand's layer of them does not tell already. */
const float OWN_IN_STANDS = 0.38;

/* `facing`: a normal, or the mean of many, shorter than 1, and how far their z spread, squared. `mirror`:
 * unit, where a ray of the eye goes on to from one leaf.
 * `past_trees`: the sun's share at the place. */
wd_around light_around(vec4 facing, vec3 mirror, wd_shelter shelter, float ground_share, float past_trees,
                       wd_alone alone, float eye_z)
{
    vec3 n = facing.xyz, s = frame.leaf_scatter;
    /* Slanting rays meet more of the stand's leaves, and of the tree's own (below). */
    float deep = min(shelter.under * UNDER_PER_LOG2, UNDER_MOST) * (1.0 - alone.share);
    vec3 odd = mix(SKY_ODD(frame.sky_form, n), SKY_ODD(frame.sky_under, n), deep);
    vec3 even = mix(SKY_EVEN(frame.sky_form, n), SKY_EVEN(frame.sky_under, n), deep)
                + frame.sky_form[6] * facing.w;
    vec4 through = exp2(frame.sky_slant * log2(shelter.through));
    vec3 open_sky = sky_level(vec4(1.0));
    vec3 reach = sky_level(through) / max(open_sky, vec3(1e-12))
                 * mix(vec3(1.0), frame.sky_under_tint, deep);
    float mean = dot(shelter.through, vec4(0.25));
    /* Upright, less: low rays meet more leaves; numbers fitted to the integral over an even layer and to path-traced
     * crowns from within. What an eye over the stand sees of upright faces looks out of a gap. */
    float own = min(mean * exp2(-shelter.under), 1.0), own4 = own * own * own * own;
    float up_to = looks_up(-eye_z), low = mix(0.40, 0.33, up_to);
    float out_of_gap = max(smoothstep(0.15, 0.5, eye_z), OF_EDGE * (1.0 - shelter.within));
    float upright = mix(low + (0.85 - low) * own + 0.15 * own4, 1.0, out_of_gap);
    float near = mix(1.0, NEXT_LEAVES, alone.leaf * up_to);
    vec3 gain = 1.0 + (exp2((s - 1.0) * log2(mean)) - 1.0) * (near * out_of_crowns(s, mean));
    gain = mix(gain, max(gain, alone.again), alone.leaf); /* of its own crown where the stand is open */
    vec3 sky = reach * gain * mix(upright, 1.0, abs(n.z));
    vec4 bright = quarters_bright(), faced = faced_quarters(n.xy);
    float flat_on = min(sqrt(n.z * n.z + facing.w), 1.0);
    vec3 sky_of_front = max(even + odd, vec3(0.0)), sky_of_back = max(even - odd, vec3(0.0));
    vec3 beside_front = alone.again * sky_faced(alone, bright * faced, flat_on, sky_of_front)
                        * sky_of_side(alone.side, bright, faced);
    vec3 beside_back = alone.again * sky_faced(alone, bright - bright * faced, flat_on, sky_of_back)
                       * sky_of_side(alone.side, bright, 1.0 - faced);
    vec3 sky_front = mix(sky, beside_front * alone.lets.x, alone.known);
    vec3 sky_back = mix(sky, beside_back * alone.lets.y, alone.known);
    /* The low sky past the stand's edge is an open sky's, however steeply light comes down within. */
    float edge = by_light(alone.edge, bright * faced) * sqrt(max(1.0 - n.z * n.z, 0.0));
    vec3 open_front = max(SKY_EVEN(frame.sky_form, n) + SKY_ODD(frame.sky_form, n), vec3(0.0));
    vec3 low_within = LOW_OF_LEVEL * open_sky * mix(vec3(1.0), frame.sky_under_tint, deep); /* which `reach` has */
    vec3 low_level = low_of_level(frame.sky_form[0], open_sky) - low_within;
    vec3 low_in = edge * low_share(open_front, 0.5 * open_sky) * open_front
                  + by_light(alone.edge, bright) * max(n.z, 0.0) * max(low_level, vec3(0.0));
    float rise = max(frame.sun_direction.z, 0.0);
    float longer = 0.67 / max(rise, 0.05);
    float beam = exp2(longer * log2(dot(frame.sunward, shelter.through)));
    vec3 sun = sunlight() * (rise * ground_share);
    vec3 diffuse = exp2(s * log2(mean));
    vec3 between = (sqrt(diffuse * beam) * 2.0 + 0.5 * (diffuse + beam)) * (1.0 / 3.0);
    vec3 scattered = sun * (s - 1.0) * (longer * 0.6931 * log2(mean)) * between * (near * out_of_crowns(s, mean));
    vec3 with_scattered = sun * mix(beam, past_trees, shelter.low) + scattered;
    float covered = 1.0 - shelter.floor_mean;
    vec3 deep_albedo = (1.0 - s) / (1.0 + s);
    vec3 floor_albedo = mix(deep_albedo, mix(frame.grass, frame.litter, covered),
                            exp2(2.0 * s * shelter.floor_herbs));
    floor_albedo = mix(floor_albedo, WD_SNOW_ALBEDO, shelter.snow);
    vec3 below = mix(deep_albedo, floor_albedo, exp2(2.0 * s * min(log2(shelter.floor_mean / mean), 0.0)));
    vec3 at_place = mix(sky, 0.5 * OF_UPWARD * (sky_front + sky_back), alone.by_crown);
    vec3 upward = below * (open_sky * at_place + with_scattered);
    float beside_lit = exp2(longer * log2(max(dot(frame.sunward, alone.beside), 1e-3)));
    vec3 beside = alone.again * floor_albedo * (sky_level(alone.beside) + sun * beside_lit);
    vec3 beyond = 0.5 * floor_albedo * (open_sky + sun); /* ground before the stand, less what stems hide of it */
    vec3 upward_front = mix(upward + edge * beyond, beside * alone.lets.z, alone.share);
    vec3 upward_back = mix(upward, beside * alone.lets.w, alone.share);
    float up = 0.5 + 0.5 * n.z;
    wd_around around;
    vec3 again = alone.scattered * mix(OWN_IN_STANDS * mean, 1.0, alone.share);
    around.front = sky_of_front * sky_front + low_in * (1.0 - alone.known)
                   + scattered * (up * (1.0 - alone.share)) + again;
    around.back = sky_of_back * sky_back
                  + scattered * ((1.0 - up) * (1.0 - alone.share)) + again;
    around.front += upward_front * (1.0 - up);
    around.back += upward_back * up;
    /* The sky's mean about that way, and past the stand: rough wax looks higher, too, and where the eye looks
     * into a gap, out of that. */
    float up_mirror = smoothstep(-LOBE_SINE, LOBE_SINE, mirror.z), high = max(mirror.z, 0.0);
    vec3 level = vec3(mirror.xy, high);
    vec3 ahead = mix(SKY_LEVELS(frame.sky_form, level), SKY_LEVELS(frame.sky_under, level), deep) / (0.5 + 0.5 * high);
    float rise_along = max(high, 0.1);
    float ways = 0.6931 * mix(ALONG, ALONG_WITHIN, shelter.within * max(up_to, 1.0 - alone.leaf));
    vec3 along = 1.0 / (1.0 - s * (shelter.beside * ways / rise_along));
    along = mix(along, vec3(sky_toward(alone, mirror)), alone.by_crown);
    float open = 0.5 * dot(alone.beside, faced_quarters(mirror.xy));
    around.mirrored = mix(upward_front, max(ahead, vec3(0.0)) * mix(along, vec3(open), alone.share)
                                            + scattered * (1.0 - alone.share), up_mirror);
    return around;
}
