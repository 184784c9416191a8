/* Light of a sward: grasses that close over the ground.
 * Expects `frame`, WD_WAX, WD_LEAF_CASCADES and lib/skylight.glsl. */

/* Light of a layer's leaves whose way up through others is `over` times the mean way to the next one:
 * the even sky's share that comes down (the exponential integral E2, within 3%). */
float through_layer(float over)
{
    return exp(-1.95 * pow(over, 0.75));
}

/* Skylight that the wax of a sward's blades mirrors toward the eye, over a white wall's: as much from
 * every side, and from the horizon ahead the more, the flatter the eye's ray. The integral over blades of
 * every direction, under an even sky, gave 0.023 (1 - sine)^2 for that, half of what a wall before such a
 * sky would get; beside path-traced meadows it is four times as much. `open`: share of the sky that reaches the sward;
 * `low`: of the low sky of each quarter, which a flat ray goes on to where a meadow lies before a lake; in stands gaps
 * below crowns let it through, too. */
vec3 sward_sheen(vec3 direction, float over, float open, vec4 low)
{
    vec3 ahead = vec3(direction.xy * inversesqrt(dot(direction.xy, direction.xy) + 1e-6), 0.0);
    float flat_on = 1.0 - min(abs(direction.z), 1.0);
    vec3 horizon = SKY_EVEN(frame.sky_form, ahead) + SKY_ODD(frame.sky_form, ahead);
    vec4 toward = max(vec4(ahead.xy, -ahead.xy), vec4(0.0));
    float open_ahead = max(dot(low, toward * toward), open);
    return 0.5 * WD_WAX * through_layer(over) * open * frame.sky_irradiance
           + 0.2 * flat_on * flat_on * exp(-over) * open_ahead * max(horizon, vec3(0.0));
}

/* The ground by itself sees 0.85 of the sky and more; a sward that takes of that takes of the sun, too,
 * where the map does not hold its blades. */
float through_sward(float openness, uint cascade)
{
    float beam = 0.67 / max(frame.sun_direction.z, 0.05);
    return pow(min(openness * (1.0 / 0.85), 1.0), cascade < WD_LEAF_CASCADES ? 0.5 * beam : beam);
}

/* Blades in a sward bend over, and hide one another's lower sides: share of upper ones among those that are seen, and
 * that reflect. */
const float BLADES_BEND = 0.85, BLADES_LIT = 0.95;

/* A sward's top is not level: under a low sun tufts stand before one another, which cards do not show.
 * Fitted to path-traced meadows under suns of 16, 24 and 45 degrees. */
float sward_tufts_lit()
{
    return mix(0.4, 1.0, smoothstep(0.2, 0.75, frame.sun_direction.z));
}

/* Where discs are wider than the gaps between tufts an eye sees those of the sward's top before all others, which is
 * lighter than the sides of tufts that it would see, and by nothing in the shade of its neighbours. Blades and narrow
 * discs of low swards have less of the sky than they should, not those of reeds. Factors on their light of the sun and
 * of the sky; `wide_m`: of a disc's pixel, 0 of blades. By path-traced meadows from 1.7 and 7 m, through lenses of 40
 * and 14 degrees, under clouds and under suns from three sides, and beds of reeds. */
vec2 sward_light(float wide_m, float tall_m, vec3 eye)
{
    float wide = wide_m / tall_m, with_light = smoothstep(-0.9, 0.5, dot(eye, frame.sun_direction));
    float sun = mix(0.32, 0.2, smoothstep(0.3, 1.2, wide)) * smoothstep(0.0, 0.15, wide);
    sun *= with_light * (1.0 - smoothstep(0.25, 0.6, eye.z));
    float narrow = mix(1.12, 1.0, smoothstep(0.4, 0.8, tall_m));
    return vec2(1.0 - sun, mix(narrow, 0.6, smoothstep(0.0, 0.9, wide)));
}
