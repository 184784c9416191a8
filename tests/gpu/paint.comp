#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform writeonly image2D target;
layout(set = 0, binding = 1, std430) readonly buffer Unused { uint unused[]; };
void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, imageSize(target))))
        imageStore(target, p, vec4(p.x, p.y, 7, 255) / 255.0);
}
