#version 460
/* A triangle over the whole target. */

void main()
{
    gl_Position = vec4(float(gl_VertexIndex & 1) * 4.0 - 1.0, float(gl_VertexIndex >> 1) * 4.0 - 1.0,
                       0.0, 1.0);
}
