/* A leaf's mirrors_beyond among the flat values that its vertices hand to its fragments. */
uint pack_mirrors(float beyond)
{
    return uint(beyond * 15.0 + 0.5) << 4;
}

float unpack_mirrors(uint flat_word)
{
    return float(flat_word >> 4 & 15u) * (1.0 / 15.0);
}
