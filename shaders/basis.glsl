// A frame around a normal.
#ifndef BASIS_GLSL
#define BASIS_GLSL

#include "exact.glsl"

struct basis {
    vec3 x, y, n; // unit, at right angles
};

// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6-1, 2017.
basis basis_around(vec3 n)
{
    float side = n.z < 0.0 ? -1.0 : 1.0;
    float a = -ex_rcp(side + n.z), b = n.x * n.y * a;
    return basis(vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x),
                 vec3(b, side + n.y * n.y * a, -n.y), n);
}

vec3 to_local(basis b, vec3 v)
{
    return vec3(ex_dot(v, b.x), ex_dot(v, b.y), ex_dot(v, b.n));
}

vec3 to_world(basis b, vec3 v)
{
    return b.x * v.x + b.y * v.y + b.n * v.z;
}

#endif
