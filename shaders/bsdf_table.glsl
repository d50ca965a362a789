// What rough surfaces reflect in all, from tables (tools/make_albedo.c).
#ifndef BSDF_TABLE_GLSL
#define BSDF_TABLE_GLSL

#include "bindings.glsl"
#include "exact.glsl"
#include "scene_data.glsl"

// A square of cells^2 rows from `first` on, at x, y within 0..1.
float table_at(uint first, uint cells, float x, float y)
{
    vec2 at = clamp(vec2(x, y), 0.0, 1.0) * float(cells);
    vec2 cell = min(floor(at), vec2(float(cells) - 1.0)), f = at - cell;
    vec4 v = scene_row_float(first + uint(int(cell.y)) * cells + uint(int(cell.x)));
    vec2 along = v.xz * (1.0 - f.x) + v.yw * f.x;
    return along.x * (1.0 - f.y) + along.y * f.y;
}

float albedo_at(uint table, float x, float y)
{
    return table_at(frame.albedo + table * LR_ALBEDO_ROWS, uint(LR_ALBEDO_CELLS), x, y);
}

// Where the tables of microfacets have a cosine: finer where one is about as wide as the other.
float facet_place(float cosine, float alpha)
{
    return ex_sqrt(cosine * (1.0 + alpha) * ex_rcp(cosine + alpha));
}

// The share of light from all around that GGX microfacets of a perfect mirror send to wo at once, with
// no second bounce among them.
float ggx_albedo(float cosine, float alpha)
{
    return albedo_at(LR_ALBEDO_GGX, facet_place(cosine, alpha), ex_sqrt(alpha));
}

// The mean of Schlick's weight in that light.
float ggx_schlick(float cosine, float alpha)
{
    float root = albedo_at(LR_ALBEDO_SCHLICK, ex_sqrt(cosine), ex_sqrt(alpha)), root2 = root * root;
    return root2 * root2 * root;
}

// The share that rough glass reflects and lets through at once; ratio is the index of refraction on wo's
// side over that on the other. Beyond 1/3 .. 3 it is taken to change no more.
float glass_albedo(float cosine, float alpha, float ratio)
{
    float tone = (1.0 - ratio) * ex_rcp(1.0 + ratio);
    float at = clamp(tone + 0.5, 0.0, 1.0) * float(LR_GLASS_LAYERS - 1);
    float layer = min(floor(at), float(LR_GLASS_LAYERS - 2)), f = at - layer;
    uint first = frame.glass_albedo + uint(int(layer)) * LR_GLASS_ROWS;
    float x = facet_place(cosine, alpha), y = ex_sqrt(alpha);
    return table_at(first, uint(LR_GLASS_CELLS), x, y) * (1.0 - f) +
           table_at(first + LR_GLASS_ROWS, uint(LR_GLASS_CELLS), x, y) * f;
}

// What sheen of the colour 1 reflects.
float sheen_albedo(float cosine, float alpha)
{
    return albedo_at(LR_ALBEDO_SHEEN, cosine, ex_sqrt(alpha));
}

#endif
