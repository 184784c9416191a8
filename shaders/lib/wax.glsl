/* Half the width of a leaf's lobe, as a sine. */
const float LOBE_SINE = 0.3;

/* Where most of the light comes from that a leaf's wax sends on along `direction`, which is from the eye; unit.
 * Facets of rough wax that a flat look sees lean toward it: their light comes from higher above the leaf than off a
 * smooth one. The mean of GGX's lobe with its Fresnel share (Walter et al. 2007; Heitz 2018) for a roughness of
 * 0.49, within 2 degrees; `normal` faces the eye. */
vec3 wax_mirror(vec3 direction, vec3 normal)
{
    float toward = -dot(direction, normal), squared = toward * toward;
    float rise = sqrt(sqrt(squared * squared + 0.0168));
    vec3 level = direction + toward * normal;
    return normal * rise + level * sqrt(max(1.0 - rise * rise, 0.0) / max(1.0 - squared, 1e-4));
}
