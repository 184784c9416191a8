#version 460
#include "shared/types.h"
#include "shared/hash.h"

layout(location = 3) flat in uvec3 in_flat;
layout(location = 4) flat in float in_show;

void main()
{
    if (wd_hash_unit(in_flat.z) >= in_show)
        discard;
}
