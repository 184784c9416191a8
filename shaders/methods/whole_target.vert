#version 460
/* A triangle over the whole target, behind all that has depth. */

void main()
{
    gl_Position = vec4(float(gl_VertexIndex & 1) * 4.0 - 1.0, float(gl_VertexIndex >> 1) * 4.0 - 1.0,
                       1e-12, 1.0);
}
