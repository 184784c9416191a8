/* What a cascade is wanted for. Expects `view` (wd_splat_view). */

/* Whether what the camera sees of the cascade's slice may lie in the shade of something at `at`, which
 * reaches so far from there, both in clip coordinates. */
bool may_shade(vec2 at, float reach)
{
    float least = 1e9;
    for (uint i = 0u; i < WD_SPLAT_SIDES; i++)
        least = min(least, dot(view.slice[i].xy, at) + view.slice[i].z);
    return least + reach >= 0.0;
}
