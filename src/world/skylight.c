#include "world/skylight.h"

#include <math.h>
#include <string.h>

#include "base/dmath.h"

enum { RINGS = WD_SKYLIGHT_RINGS, BEARINGS = WD_SKYLIGHT_BEARINGS, FORMS = 9 };
static const float PI = (float)WD_PI;

/* Moments of the radiance that spherical harmonics up to the second order are made of. */
static void forms_of(struct wd_vec3 d, float forms[FORMS])
{
    const float values[FORMS] = {1,         d.x,       d.y,       d.z,
                                 d.x * d.y, d.y * d.z, d.z * d.z, d.x * d.z,
                                 d.x * d.x - d.y * d.y};
    memcpy(forms, values, sizeof values);
}

/* A layer of leaves such as a forest's. */
static const float LAYER_DEPTH = 0.65f;

struct slants {
    float whole[4], through[4], even, even_through;
};

/* What of a quarter's light such a layer lets through, beside what it would of an even sky's. */
static void add_slants(struct slants *slants, const float share[4], float weight, float rise)
{
    float through = expf(-LAYER_DEPTH / rise);
    for (int quarter = 0; quarter < 4; quarter++) {
        slants->whole[quarter] += share[quarter] * weight;
        slants->through[quarter] += share[quarter] * weight * through;
    }
    slants->even += rise;
    slants->even_through += rise * through;
}

/* And one as deep as a closed forest. */
static const float UNDER_DEPTH = 3;

/* Light that arrives over a solid angle, cosine and all: half of it to either quarter where it comes
 * from between two. */
static void add_quarters(struct wd_frame_uniforms *frame, struct slants *slants, struct wd_vec3 d,
                         const float light[3])
{
    float across2 = d.x * d.x + d.y * d.y;
    float share[4] = {d.x > 0 ? d.x * d.x : 0, d.y > 0 ? d.y * d.y : 0, d.x < 0 ? d.x * d.x : 0,
                      d.y < 0 ? d.y * d.y : 0};
    for (int quarter = 0; quarter < 4; quarter++)
        share[quarter] /= across2;
    for (int quarter = 0; quarter < 4; quarter++)
        for (int k = 0; k < 3; k++)
            frame->sky_quarters[quarter][k] += light[k] * d.z * share[quarter];
    add_slants(slants, share, light[1] * d.z, d.z);
}

/* The sky about the sun is bright, a third of a clear sky's light: leaves that the sun reaches have that as
 * well, and shaded ones little of it. What is brighter there than the sky between the second and the third of
 * these angles counts whole nearer than the first and not at all beyond the second. In degrees. */
static const float NEAR_SUN_DEG = 15, OFF_SUN_DEG = 35, FAR_SUN_DEG = 55;

struct about_sun {
    struct wd_vec3 sun, rest; /* `rest`: radiance of the sky farther off */
    float gate;               /* 0: there is no sun */
};

static float from_sun_deg(const struct about_sun *about, struct wd_vec3 d)
{
    return acosf(wd_clampf(wd_v3_dot(d, about->sun), -1, 1)) * (180 / PI);
}

/* What of a direction's radiance is circumsolar. */
static struct wd_vec3 circumsolar(const struct about_sun *about, struct wd_vec3 d, struct wd_vec3 radiance)
{
    float x = wd_clampf((OFF_SUN_DEG - from_sun_deg(about, d)) / (OFF_SUN_DEG - NEAR_SUN_DEG), 0, 1);
    float share = about->gate * x * x * (3 - 2 * x);
    struct wd_vec3 more = wd_v3_sub(radiance, about->rest);
    return wd_v3_scale(WD_V3(fmaxf(more.x, 0), fmaxf(more.y, 0), fmaxf(more.z, 0)), share);
}

/* As light from the sun's direction: as much on level ground, but of a very low sun, which lights that least. */
static void add_circumsolar(struct wd_frame_uniforms *frame, const struct about_sun *about, struct wd_vec3 d,
                            struct wd_vec3 light)
{
    const float level[3] = {light.x * d.z, light.y * d.z, light.z * d.z};
    for (int k = 0; k < 3; k++) {
        frame->sky_irradiance[k] += level[k];
        frame->circumsolar[k] += level[k] / fmaxf(about->sun.z, 0.2f);
    }
}

static void add_direction(struct wd_frame_uniforms *frame, struct slants *slants, struct wd_vec3 d,
                          struct wd_vec3 radiance, float solid_angle)
{
    float forms[FORMS];
    const float light[3] = {radiance.x * solid_angle, radiance.y * solid_angle,
                            radiance.z * solid_angle};
    forms_of(d, forms);
    float under = expf(-UNDER_DEPTH / d.z);
    for (int form = 0; form < FORMS; form++)
        for (int k = 0; k < 3; k++) {
            frame->sky_form[form][k] += forms[form] * light[k];
            frame->sky_under[form][k] += forms[form] * light[k] * under;
        }
    add_quarters(frame, slants, d, light);
    for (int k = 0; k < 3; k++)
        frame->sky_irradiance[k] += d.z * light[k];
}

/* From moments to irradiance as a polynomial in the normal: each order of the harmonics times what a
 * cosine lobe leaves of it, pi, 2 pi / 3, pi / 4 (Ramamoorthi and Hanrahan 2001). */
static void settle_forms(float form[FORMS][3])
{
    const float first = 2 * PI / 3 * (3 / (4 * PI)), second = PI / 4;
    const float cross = second * (15 / (4 * PI)), height = second * (5 / (16 * PI));
    for (int k = 0; k < 3; k++) {
        float mean = form[0][k], zz = 3 * form[6][k] - mean;
        form[0][k] = mean * 0.25f - height * zz;
        for (int i = 1; i <= 3; i++)
            form[i][k] *= first;
        form[4][k] *= cross;
        form[5][k] *= cross;
        form[6][k] = 3 * height * zz;
        form[7][k] *= cross;
        form[8][k] *= 0.25f * cross;
    }
}

static float on_level_ground(float form[FORMS][3], int channel)
{
    return form[0][channel] + form[3][channel] + form[6][channel];
}

/* Light that comes down slantwise is dimmed the most, and so are its colours. `level`: irradiance of
 * level ground under the layer. */
static void settle_under(struct wd_frame_uniforms *frame, const float level[3])
{
    float(*form)[3] = frame->sky_under, share[3];
    settle_forms(form);
    for (int k = 0; k < 3; k++) {
        float here = on_level_ground(form, k), open = on_level_ground(frame->sky_form, k);
        for (int i = 0; i < FORMS && here > 0; i++)
            form[i][k] *= open / here;
        share[k] = open > 0 ? level[k] / open : 1;
    }
    for (int k = 0; k < 3; k++)
        frame->sky_under_tint[k] = share[1] > 0 ? share[k] / share[1] : 1;
}

static void set_sunward(struct wd_frame_uniforms *frame)
{
    float x = frame->sun_direction[0], y = frame->sun_direction[1];
    float across2 = fmaxf(x * x + y * y, 1e-8f);
    float even = x * x + y * y < 1e-8f ? 0.25f : 0;
    frame->sunward[0] = even + (x > 0 ? x * x / across2 : 0);
    frame->sunward[1] = even + (y > 0 ? y * y / across2 : 0);
    frame->sunward[2] = even + (x < 0 ? x * x / across2 : 0);
    frame->sunward[3] = even + (y < 0 ? y * y / across2 : 0);
}

struct wd_vec3 wd_skylight_direction(float ring, float bearing)
{
    float rise = ring / RINGS, across = sqrtf(1 - rise * rise);
    float turn = bearing * (2 * PI / BEARINGS);
    return WD_V3(across * cosf(turn), across * sinf(turn), rise);
}

static struct wd_vec3 part_direction(int part)
{
    return wd_skylight_direction((float)(part / BEARINGS) + 0.5f, (float)(part % BEARINGS) + 0.5f);
}

static struct about_sun about_sun_of(const struct wd_frame_uniforms *frame,
                                     const struct wd_vec3 sky[RINGS * BEARINGS])
{
    struct about_sun about = {.sun = wd_v3_of(frame->sun_direction)};
    float count = 0, up = wd_clampf(about.sun.z * 10, 0, 1);
    for (int part = 0; part < RINGS * BEARINGS; part++) {
        float off_deg = from_sun_deg(&about, part_direction(part));
        if (off_deg < OFF_SUN_DEG || off_deg > FAR_SUN_DEG)
            continue;
        about.rest = wd_v3_add(about.rest, sky[part]);
        count++;
    }
    about.rest = wd_v3_scale(about.rest, 1 / fmaxf(count, 1));
    about.gate = frame->sun_irradiance[1] > 0 && count > 0 ? up : 0;
    return about;
}

void wd_skylight_fill(struct wd_frame_uniforms *frame, wd_skylight_radiance *radiance,
                      const void *user)
{
    const float solid_angle = 2 * PI / (RINGS * BEARINGS);
    struct wd_vec3 sky[RINGS * BEARINGS];
    struct slants slants = {0};
    for (int part = 0; part < RINGS * BEARINGS; part++)
        sky[part] = radiance(user, part_direction(part));
    struct about_sun about = about_sun_of(frame, sky);
    memset(frame->sky_irradiance, 0, sizeof frame->sky_irradiance);
    memset(frame->circumsolar, 0, sizeof frame->circumsolar);
    memset(frame->sky_form, 0, sizeof frame->sky_form);
    memset(frame->sky_under, 0, sizeof frame->sky_under);
    memset(frame->sky_quarters, 0, sizeof frame->sky_quarters);
    for (int part = 0; part < RINGS * BEARINGS; part++) {
        struct wd_vec3 d = part_direction(part);
        struct wd_vec3 near_sun = circumsolar(&about, d, sky[part]);
        add_circumsolar(frame, &about, d, wd_v3_scale(near_sun, solid_angle));
        add_direction(frame, &slants, d, wd_v3_sub(sky[part], near_sun), solid_angle);
    }
    float under[3]; /* the moment of rise is the irradiance of level ground */
    memcpy(under, frame->sky_under[3], sizeof under);
    settle_forms(frame->sky_form);
    settle_under(frame, under);
    set_sunward(frame);
    for (int quarter = 0; quarter < 4; quarter++)
        frame->sky_slant[quarter] =
            slants.through[quarter] > 0
                ? logf(slants.through[quarter] / slants.whole[quarter]) /
                      logf(slants.even_through / slants.even)
                : 1;
}
