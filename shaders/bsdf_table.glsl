// What rough surfaces reflect in all, from tables (tools/make_albedo.c).
#ifndef BSDF_TABLE_GLSL
#define BSDF_TABLE_GLSL

#include "bindings.glsl"
#include "exact.glsl"
#include "scene_data.glsl"

// A rectangle of columns x rows cells from row `first` on, at x, y within 0..1.
float table_at(uint first, uint columns, uint rows, float x, float y)
{
    vec2 cells = vec2(float(columns), float(rows)), at = clamp(vec2(x, y), 0.0, 1.0) * cells;
    vec2 cell = min(floor(at), cells - 1.0), f = at - cell;
    vec4 v = scene_row_float(first + uint(int(cell.y)) * columns + uint(int(cell.x)));
    vec2 along = v.xz * (1.0 - f.x) + v.yw * f.x;
    return along.x * (1.0 - f.y) + along.y * f.y;
}

float albedo_at(uint table, float x, float y)
{
    return table_at(frame.albedo + table * LR_ALBEDO_ROWS, uint(LR_ALBEDO_CELLS), uint(LR_ALBEDO_CELLS),
                    x, y);
}

// Where the tables of microfacets have a width: 0 for LR_ALPHA_MIN.
float alpha_place(float alpha)
{
    return (ex_sqrt(alpha) - 0.0316227766) * 1.03265547;
}

// Where they have a cosine: finer where one is about as wide as the other.
float facet_place(float cosine, float alpha)
{
    return ex_sqrt(cosine * (1.0 + alpha) * ex_rcp(cosine + alpha));
}

// The share of light from all around that GGX microfacets of a perfect mirror send to wo at once, with
// no second bounce among them.
float ggx_albedo(float cosine, float alpha)
{
    return albedo_at(LR_ALBEDO_GGX, facet_place(cosine, alpha), alpha_place(alpha));
}

// The mean of Schlick's weight in that light.
float ggx_schlick(float cosine, float alpha)
{
    float x = 0.5 * (cosine + facet_place(cosine, alpha));
    float root = albedo_at(LR_ALBEDO_SCHLICK, x, alpha_place(alpha)) + 1.0 - cosine, root2 = root * root;
    return root2 * root2 * root;
}

// Where light on its way out has a cosine: finer around the one beyond which reflection is total, too.
float critical_place(float cosine, float alpha, float critical)
{
    float away = cosine - critical, width = 1.0 - critical;
    float step = away * ex_rcp(alpha + abs(away));
    float first = -critical * ex_rcp(alpha + critical), last = width * ex_rcp(alpha + width);
    return 0.5 * cosine + 0.2 * facet_place(cosine, alpha) +
           0.3 * (step - first) * ex_rcp(last - first);
}

// The share that rough glass reflects and lets through at once; ratio is the index of refraction on wo's
// side over that on the other. Beyond 1/4 .. 4 it is taken to change no more.
float glass_albedo(float cosine, float alpha, float ratio)
{
    bool leaves = ratio > 1.0;
    float tone = abs(1.0 - ratio) * ex_rcp(1.0 + ratio), root = ex_sqrt(tone);
    float layers = float(leaves ? LR_GLASS_OUT_OF : LR_GLASS_INTO) - 1.0;
    float at = clamp((ex_sqrt(root) - LR_GLASS_FIRST) * 1.76991150, 0.0, 1.0) * layers;
    float layer = min(floor(at), layers - 1.0), f = at - layer;
    float critical = 2.0 * root * ex_rcp(1.0 + tone);
    float x = mix(facet_place(cosine, alpha), critical_place(cosine, alpha, critical), leaves);
    float y = alpha_place(alpha);
    uint number = uint(int(layer)) + (leaves ? uint(LR_GLASS_INTO) : 0u);
    uint first = frame.glass_albedo + number * LR_GLASS_CELLS;
    uint columns = uint(LR_GLASS_COLUMNS), rows = uint(LR_GLASS_ROWS);
    float share = table_at(first, columns, rows, x, y) * (1.0 - f) +
                  table_at(first + LR_GLASS_CELLS, columns, rows, x, y) * f;
    return share * ggx_albedo(cosine, alpha);
}

// What sheen of the colour 1 reflects.
float sheen_albedo(float cosine, float alpha)
{
    return albedo_at(LR_ALBEDO_SHEEN, ex_sqrt(cosine), (ex_sqrt(alpha) - 0.1) * 1.11111111);
}

#endif
