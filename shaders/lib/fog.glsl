/* Aerial perspective: haze that thins exponentially with height, integrated along the view ray.
 * Expects `frame` and lib/sky.glsl. */

/* Metres of air at full density that a ray of this length passes. */
float fog_path_m(vec3 direction, float length_m)
{
    float eye_z = float(frame.camera_mm[2]) * 0.001;
    float per_height = 1.0 / frame.fog_height_m;
    float at_eye = exp(clamp((frame.fog_base_m - eye_z) * per_height, -20.0, 1.5));
    float fall = direction.z * length_m * per_height;
    float mean = abs(fall) > 1e-3 ? (1.0 - exp(-max(fall, -8.0))) / fall : 1.0 - 0.5 * fall;
    return at_eye * mean * length_m;
}

/* Air scatters blue more than haze does: extinction per band, about 1 at 550 nm. */
const vec3 FOG_BANDS = vec3(0.80, 1.0, 1.34);

vec3 fog_through(vec3 direction, float length_m)
{
    return exp(-FOG_BANDS * (frame.fog_per_m * fog_path_m(direction, length_m)));
}

/* `sunlit`: share of the way on which the ground lets the sun reach the haze. */
vec3 apply_fog(vec3 radiance, vec3 direction, float length_m, float sunlit)
{
    vec3 through = fog_through(direction, length_m);
    return mix(horizon_radiance(direction, mix(0.45, 1.0, sunlit)), radiance, through);
}
