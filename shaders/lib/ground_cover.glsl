/* What grows or lies on the ground at a place, by slope, height, canopy and chance.
 * Expects `frame` and lib/noise.glsl. */

struct ground_look {
    vec3 albedo;
    vec3 normal;
    float openness; /* share of the sky that the canopy leaves */
};

/* Noise of the place at the sizes that the rules below ask for; each ends before it shimmers. */
struct ground_noise {
    float broad;   /* 131 m */
    float middle;  /* 16 m */
    float small_;  /* 2 m */
    float fine;    /* of the size of a few pixels, at most half a metre */
    vec2 bump;     /* slope that the smaller ones add */
};

/* Detail at whatever size pixels show best: three octaves that follow the footprint, each coming
 * in and going out smoothly. */
vec3 fine_noise(vec2 rel, float footprint_m)
{
    float octave = clamp(log2(footprint_m * 1500.0), 3.0, 8.0);
    int bits = int(octave);
    float rest = octave - float(bits);
    vec3 fine = gradient_noise(lattice_at(rel, bits), 4u) * (1.0 - rest)
                + gradient_noise(lattice_at(rel, bits + 1), 4u)
                + gradient_noise(lattice_at(rel, bits + 2), 4u) * rest;
    return fine * noise_share(footprint_m, 9);
}

ground_noise ground_noise_at(vec2 rel, float footprint_m)
{
    ground_noise n;
    vec3 fine = fine_noise(rel, footprint_m);
    vec3 wave = gradient_noise(lattice_at(rel, 11), 3u) * noise_share(footprint_m, 11);
    n.broad = gradient_noise(lattice_at(rel, 17), 1u).x;
    n.middle = gradient_noise(lattice_at(rel, 14), 2u).x * noise_share(footprint_m, 14);
    n.small_ = wave.x;
    n.fine = fine.x;
    n.bump = wave.yz * 0.05 + fine.yz * 0.22;
    return n;
}

/* Layers of rock: bands by height, tilted a little, broken by noise. */
vec3 rock_albedo(float height_m, ground_noise n, float footprint_m)
{
    float bed = height_m * 0.11 + n.broad * 3.0 + n.middle * 0.7;
    float band = (abs(fract(bed) - 0.5) * 4.0 - 1.0) * (1.0 - smoothstep(2.0, 8.0, footprint_m));
    float stain = 1.0 + 0.16 * band + 0.35 * n.small_ + 0.30 * n.fine + 0.2 * n.middle;
    return frame.rock * max(stain, 0.3) * mix(vec3(1.0), vec3(1.07, 1.0, 0.90), 0.5 + n.broad);
}

/* Meadow: dry on shoulders and knolls, lush in hollows; tufts near the eye. */
vec3 grass_albedo(float height_m, float steep, ground_noise n)
{
    float dry = clamp(0.42 + 0.8 * n.broad + 0.6 * n.middle + 0.35 * n.small_ + 0.5 * steep
                      + 0.5 * smoothstep(-400.0, 200.0, height_m - frame.tree_line_m), 0.0, 1.0);
    vec3 straw = frame.grass * vec3(1.60, 1.14, 1.10);
    vec3 lush = frame.grass * vec3(0.74, 0.88, 0.84);
    return mix(lush, straw, dry) * max(1.0 + 0.75 * n.fine + 0.22 * n.small_, 0.2);
}

/* Under trees: needles and leaves, moss in the broad lows, bare earth between. */
vec3 floor_albedo(ground_noise n)
{
    float moss = smoothstep(0.05, 0.4, n.middle + 0.6 * n.small_ + 0.3 * n.broad);
    vec3 green = mix(frame.litter, frame.grass, 0.75) * vec3(0.72, 0.95, 0.6);
    float earth = smoothstep(0.1, 0.5, n.small_ - 0.5 * n.middle);
    vec3 bare = mix(frame.litter, frame.soil, 0.6 * earth);
    return mix(bare, green, 0.7 * moss) * max(1.0 + 0.8 * n.fine, 0.2);
}

/* 0 below the snow line, 1 above; lower where it is level, none on walls. */
float snow_share(float height_m, float steep, ground_noise n)
{
    float line = frame.snow_line_m + 120.0 * n.broad + 40.0 * n.middle;
    float lies = smoothstep(-40.0, 60.0, height_m - line - 160.0 * (steep - 0.4));
    return lies * (1.0 - smoothstep(0.9, 1.4, steep + 0.3 * n.small_ + 0.2 * n.middle));
}

vec3 ground_albedo(float height_m, float steep, float cover, ground_noise n, float footprint_m)
{
    vec3 albedo = grass_albedo(height_m, steep, n);
    float shade = smoothstep(0.25, 0.75, cover + 0.35 * n.small_ + 0.2 * n.middle);
    albedo = mix(albedo, floor_albedo(n), shade);
    float worn = smoothstep(0.55, 1.0, steep / frame.rock_slope + 0.5 * n.middle + 0.25 * n.small_);
    worn = max(worn, 0.55 * smoothstep(0.30, 0.55, n.middle + n.small_ * 0.8 - cover));
    albedo = mix(albedo, frame.soil * max(1.0 + 0.6 * n.fine + 0.3 * n.small_, 0.3), 0.75 * worn);
    float over = (height_m - frame.tree_line_m) / 500.0;
    float bare = smoothstep(0.85, 1.15, steep / frame.rock_slope + 0.30 * n.middle
                            + 0.15 * n.small_ + clamp(over, 0.0, 0.9));
    albedo = mix(albedo, rock_albedo(height_m, n, footprint_m), bare);
    float beach = 1.0 - smoothstep(0.4, 1.6, abs(height_m - frame.water_level_m - 0.3) + n.small_);
    albedo = mix(albedo, frame.soil * 1.25, 0.8 * beach);
    float wet = 1.0 - smoothstep(0.0, 0.35, height_m - frame.water_level_m);
    albedo *= 1.0 - 0.45 * wet;
    return mix(albedo, vec3(0.83, 0.86, 0.90), snow_share(height_m, steep, n));
}

ground_look ground_cover(vec3 rel, vec2 slope, float cover, float footprint_m)
{
    float height_m = rel.z + float(frame.camera_mm[2]) * 0.001;
    ground_noise n = ground_noise_at(rel.xy, footprint_m);
    float steep = length(slope);
    ground_look look;
    look.albedo = clamp(ground_albedo(height_m, steep, cover, n, footprint_m), 0.0, 1.0);
    vec2 rough = slope + n.bump * (1.0 + smoothstep(0.7, 1.2, steep / frame.rock_slope) * 1.5);
    look.normal = normalize(vec3(-rough, 1.0));
    float canopy = smoothstep(0.15, 0.9, cover);
    look.openness = mix(1.0, 0.14, canopy) * (0.85 + 0.15 * clamp(1.0 + 2.0 * n.fine, 0.0, 1.0));
    return look;
}
