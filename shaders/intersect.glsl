// Ray against primitive. Each function returns the two distances at which the line of the ray
// crosses the surface, the nearer first; -1 stands for a crossing that does not exist. Distances
// behind the origin come out negative: callers keep those above 0.
#ifndef INTERSECT_GLSL
#define INTERSECT_GLSL

#include "exact.glsl"
#include "scene_data.glsl"

const vec2 miss = vec2(-1.0, -1.0);

// Unit sphere around the origin; inv_a = 1 / (d . d). The sheet's b^2 - 4 a c cancels when the
// sphere is far off, so the half chord is measured from the point q of the line that is nearest to
// the centre: disc = 1 - q . q (Haines, Guenther, Akenine-Moeller, "Precision Improvements for
// Ray/Sphere Intersection", Ray Tracing Gems, 2019). A tangent ray touches: both roots are equal.
vec2 intersect_unit_sphere(vec3 o, vec3 d, float inv_a)
{
    float t = -ex_dot(o, d) * inv_a;
    vec3 q = o + d * t;
    float disc = 1.0 - ex_dot(q, q);
    float h = ex_sqrt(disc * inv_a);
    return disc >= 0.0 ? vec2(t - h, t + h) : miss;
}

// Works in units of the radius, so spheres of 1e-20 and of 1e12 metres neither under- nor overflow.
vec2 intersect_sphere(vec3 o, vec3 d, float inv_a, gpu_sphere s)
{
    vec2 crossing = intersect_unit_sphere((o - s.center) * s.inv_radius, d, inv_a) * s.radius;
    if (has_one_sided && (s.flags & LR_FLAG_INWARD) != 0u)
        crossing.x = -1.0;
    return crossing;
}

// The sheet's t = -(c + n . p0) / (n . d), with offset = -c. As the boundary of the half-space below
// it, so that a ray from above enters at the first distance and one from below leaves at the second.
vec2 intersect_plane(vec3 o, vec3 d, vec3 normal, float offset)
{
    float along = ex_dot(normal, d);
    float t = (offset - ex_dot(normal, o)) * ex_rcp(away_from_zero(along));
    return along < 0.0 ? vec2(t, LR_BEYOND) : vec2(-1.0, t);
}

vec2 intersect_flat(vec3 o, vec3 d, gpu_flat f)
{
    float t = (f.offset - ex_dot(f.normal, o)) * ex_rcp(away_from_zero(ex_dot(f.normal, d)));
    vec3 p = o + d * t;
    float u = ex_dot(f.u, p) + f.u_offset, v = ex_dot(f.v, p) + f.v_offset;
    bool in_disk = u * u + v * v <= 1.0;
    bool in_triangle = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    bool in_rectangle = abs(u) <= 1.0 && abs(v) <= 1.0;
    bool inside = (f.flags & LR_FLAG_DISK) != 0u
                      ? in_disk
                      : ((f.flags & LR_FLAG_TRIANGLE) != 0u ? in_triangle : in_rectangle);
    if (has_one_sided)
        inside = inside && !(ex_dot(f.normal, d) > 0.0 && (f.flags & LR_FLAG_ONE_SIDED) != 0u);
    return inside && abs(t) < LR_T_MAX ? vec2(t, -1.0) : miss;
}

vec3 solid_point(gpu_solid s, vec3 p)
{
    return vec3(ex_dot(s.row0.xyz, p) + s.row0.w, ex_dot(s.row1.xyz, p) + s.row1.w,
                ex_dot(s.row2.xyz, p) + s.row2.w) *
           s.inv_scale;
}

// Without inv_scale: distances along it are in units of s.scale.
vec3 solid_direction(gpu_solid s, vec3 d)
{
    return vec3(ex_dot(s.row0.xyz, d), ex_dot(s.row1.xyz, d), ex_dot(s.row2.xyz, d));
}

// A normal of the solid's own space in world space, of unit length.
vec3 solid_normal(gpu_solid s, vec3 n)
{
    return ex_normalize(s.row0.xyz * n.x + s.row1.xyz * n.y + s.row2.xyz * n.z);
}

vec2 intersect_ellipsoid(vec3 so, vec3 sd)
{
    return intersect_unit_sphere(so, sd, ex_rcp(ex_dot(sd, sd)));
}

// Slabs (Kay and Kajiya, 1986).
vec2 intersect_box(vec3 so, vec3 sd)
{
    vec3 inverse = vec3(ex_rcp(away_from_zero(sd.x)), ex_rcp(away_from_zero(sd.y)),
                        ex_rcp(away_from_zero(sd.z)));
    vec3 low = (vec3(-1.0) - so) * inverse, high = (vec3(1.0) - so) * inverse;
    vec3 near = min(low, high), far = max(low, high);
    float first = max(near.x, max(near.y, near.z)), last = min(far.x, min(far.y, far.z));
    return first <= last ? vec2(first, last) : miss;
}

// Whether direction sd crosses the side of a cone at p from outside.
bool leads_in(gpu_solid s, vec3 p, vec3 sd)
{
    float r = s.radius_from + s.radius_slope * p.z;
    return p.x * sd.x + p.y * sd.y - s.radius_slope * r * sd.z < 0.0;
}

// x^2 + y^2 = r(z)^2 with r(z) = radius_from + z radius_slope, cut off at z = 0 and z = 1, with or
// without the end caps. The origin is first moved to the point nearest to the middle of the axis:
// the textbook quadratic loses its digits when the cone is far off.
vec2 intersect_cone(vec3 so, vec3 sd, gpu_solid s)
{
    float shift = ex_dot(vec3(0.0, 0.0, 0.5) - so, sd) * ex_rcp(ex_dot(sd, sd));
    vec3 q = so + sd * shift;
    float r = s.radius_from + s.radius_slope * q.z, dr = s.radius_slope * sd.z;
    float a = sd.x * sd.x + sd.y * sd.y - dr * dr;
    float b = q.x * sd.x + q.y * sd.y - r * dr;
    float c = q.x * q.x + q.y * q.y - r * r;
    float disc = b * b - a * c;
    float root = ex_sqrt(disc);
    float k = away_from_zero(b < 0.0 ? root - b : -b - root);
    float ta = k * ex_rcp(away_from_zero(a)), tb = c * ex_rcp(k);
    float za = q.z + ta * sd.z, zb = q.z + tb * sd.z;
    bool has_a = disc >= 0.0 && za >= 0.0 && za <= 1.0;
    bool has_b = disc >= 0.0 && zb >= 0.0 && zb <= 1.0;
    if (has_one_sided && (s.flags & LR_FLAG_ONE_SIDED) != 0u) {
        bool outward = (s.flags & LR_FLAG_INWARD) == 0u;
        has_a = has_a && leads_in(s, q + sd * ta, sd) == outward;
        has_b = has_b && leads_in(s, q + sd * tb, sd) == outward;
    }

    float inverse = ex_rcp(away_from_zero(sd.z));
    float t0 = -q.z * inverse, t1 = (1.0 - q.z) * inverse;
    vec2 p0 = q.xy + sd.xy * t0, p1 = q.xy + sd.xy * t1;
    float r0 = s.radius_from, r1 = s.radius_from + s.radius_slope;
    bool closed = (s.flags & LR_FLAG_OPEN) == 0u;
    bool has_0 = closed && p0.x * p0.x + p0.y * p0.y <= r0 * r0;
    bool has_1 = closed && p1.x * p1.x + p1.y * p1.y <= r1 * r1;

    const float none = LR_BEYOND;
    float first = min(min(has_a ? ta : none, has_b ? tb : none),
                      min(has_0 ? t0 : none, has_1 ? t1 : none));
    float last = max(max(has_a ? ta : -none, has_b ? tb : -none),
                     max(has_0 ? t0 : -none, has_1 ? t1 : -none));
    return first <= last ? vec2(first + shift, last + shift) : miss;
}

bool is_in(gpu_list list, uint i)
{
    return i >= list.begin && i < list.end;
}

// Solids share one test because on software devices every branch is paid for, and most of the cost
// lies in what they have in common.
vec2 intersect_solid(vec3 o, vec3 d, gpu_solid s, uint i)
{
    vec3 so = solid_point(s, o), sd = solid_direction(s, d);
    vec2 crossing = miss;
    if (has_ellipsoids && is_in(frame.ellipsoids, i))
        crossing = intersect_ellipsoid(so, sd);
    if (has_boxes && is_in(frame.boxes, i))
        crossing = intersect_box(so, sd);
    if (has_cones && is_in(frame.cones, i))
        crossing = intersect_cone(so, sd, s);
    return crossing * s.scale;
}

// Which face of the unit box p lies on, as its outward normal.
vec3 box_face_normal(vec3 p)
{
    vec3 a = abs(p);
    bool x = a.x >= a.y && a.x >= a.z;
    bool y = !x && a.y >= a.z;
    return vec3(x ? (p.x < 0.0 ? -1.0 : 1.0) : 0.0, y ? (p.y < 0.0 ? -1.0 : 1.0) : 0.0,
                x || y ? 0.0 : (p.z < 0.0 ? -1.0 : 1.0));
}

vec3 cone_surface_normal(gpu_solid s, vec3 p)
{
    float r = s.radius_from + s.radius_slope * p.z;
    float side = abs(ex_sqrt(p.x * p.x + p.y * p.y) - r);
    float low = abs(p.z), high = abs(1.0 - p.z);
    bool closed = (s.flags & LR_FLAG_OPEN) == 0u;
    bool on_low = closed && low < side && low <= high;
    bool on_high = closed && high < side && high < low;
    vec3 sideways = vec3(p.x, p.y, -s.radius_slope * r);
    return on_low ? vec3(0.0, 0.0, -1.0) : (on_high ? vec3(0.0, 0.0, 1.0) : sideways);
}

#endif
