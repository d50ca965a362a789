"""Mitsuba's rough materials with the light that microfacets pass on to each other, as ours have it: more
of what gets out at once, by the share that does (Turquin, "Practical multiple scattering compensation
for microfacet models", 2019). That share is sampled here from Mitsuba's own materials.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

CELLS, SAMPLES = 512, 1 << 15


def shares(bsdf):
    """What gets out of CELLS cosines to the viewer, from -1 to 1, at their middles."""
    i = np.arange(SAMPLES) + 0.5
    points = [np.tile(i * step % 1, CELLS) for step in (0.8191725134, 0.6710436067, 0.5497004779)]
    cosine = np.repeat((np.arange(CELLS) + 0.5) * (2 / CELLS) - 1, SAMPLES)
    si = dr.zeros(mi.SurfaceInteraction3f, CELLS * SAMPLES)
    si.wi = mi.Vector3f(mi.Float(np.sqrt(1 - cosine ** 2)), 0, mi.Float(cosine))
    si.n, si.sh_frame = mi.Normal3f(0, 0, 1), mi.Frame3f(mi.Normal3f(0, 0, 1))
    energy = mi.BSDFContext(mi.TransportMode.Importance)  # light, not radiance, which ior changes
    _, weight = bsdf.sample(energy, si, mi.Float(points[0]), mi.Point2f(mi.Float(points[1]), mi.Float(points[2])))
    return np.array(weight[0]).reshape(CELLS, SAMPLES).mean(1)


class Compensated(mi.BSDF):
    """`inner` times 1 + tint (1 - share) / share; the shares are those of `white`."""

    def __init__(self, props):
        super().__init__(props)
        self.inner, self.tint = props["inner"], props["tint"]
        share = np.maximum(shares(props["white"]), 1e-3)
        self.lost = mi.Float((1 - share) / share)
        self.m_components = [self.inner.flags(i) for i in range(self.inner.component_count())]
        self.m_flags = self.inner.flags()

    def factor(self, si):
        at = dr.clip((mi.Frame3f.cos_theta(si.wi) + 1) * (CELLS / 2) - 0.5, 0, CELLS - 1.001)
        i = mi.UInt32(at)
        lost = dr.lerp(dr.gather(mi.Float, self.lost, i), dr.gather(mi.Float, self.lost, i + 1), at - i)
        return 1 + mi.Color3f(self.tint) * lost

    def sample(self, ctx, si, sample1, sample2, active=True):
        bs, weight = self.inner.sample(ctx, si, sample1, sample2, active)
        return bs, weight * self.factor(si)

    def eval(self, ctx, si, wo, active=True):
        return self.inner.eval(ctx, si, wo, active) * self.factor(si)

    def pdf(self, ctx, si, wo, active=True):
        return self.inner.pdf(ctx, si, wo, active)

    def eval_pdf(self, ctx, si, wo, active=True):
        value, pdf = self.inner.eval_pdf(ctx, si, wo, active)
        return value * self.factor(si), pdf

    def to_string(self):
        return "Compensated[%s]" % self.inner


mi.register_bsdf("compensated", Compensated)
