#version 460
layout(location = 0) in vec4 color;
layout(location = 1) flat in uint triangle;
layout(location = 0) out vec4 out_color;
layout(location = 1) out uint out_id;
void main()
{
    if (color.a == 0)
        discard;
    out_color = color;
    out_id = triangle + 1;
}
