"""A mix of two of Mitsuba's materials, whose densities are those of the whole. Those that Mitsuba's own
blendbsdf samples are of the part that was chosen, and others than it evaluates: light that can be found in
two ways is weighted wrongly then, by 6 % on a ball half mirror, half matt.
"""

import drjit as dr
import mitsuba as mi


class Mixed(mi.BSDF):
    """`first`, and with the probability `weight` `second`."""

    def __init__(self, props):
        super().__init__(props)
        self.parts, self.weight = [props["first"], props["second"]], props["weight"]
        self.m_components = [p.flags(i) for p in self.parts for i in range(p.component_count())]
        self.m_flags = self.parts[0].flags() | self.parts[1].flags()

    def sample(self, ctx, si, sample1, sample2, active=True):
        second = sample1 < self.weight
        within = dr.select(second, sample1 / self.weight, (sample1 - self.weight) / (1 - self.weight))
        a, a_weight = self.parts[0].sample(ctx, si, within, sample2, active & ~second)
        b, b_weight = self.parts[1].sample(ctx, si, within, sample2, active & second)
        bs, value = dr.select(second, b, a), dr.select(second, b_weight, a_weight)
        delta = mi.has_flag(bs.sampled_type, mi.BSDFFlags.Delta)
        f, pdf = self.eval_pdf(ctx, si, bs.wo, active & ~delta)
        value = dr.select(delta, value, dr.select(pdf > 0, f / pdf, 0))
        bs.pdf = dr.select(delta, bs.pdf, pdf)
        return bs, value

    def eval(self, ctx, si, wo, active=True):
        return dr.lerp(self.parts[0].eval(ctx, si, wo, active), self.parts[1].eval(ctx, si, wo, active), self.weight)

    def pdf(self, ctx, si, wo, active=True):
        return dr.lerp(self.parts[0].pdf(ctx, si, wo, active), self.parts[1].pdf(ctx, si, wo, active), self.weight)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return "Mixed[%s]" % self.parts


mi.register_bsdf("mixed", Mixed)
