"""Curves over logarithmic axes as an SVG picture."""

import math

PANEL, HEIGHT, LEFT, BOTTOM, TOP, RIGHT = 420, 320, 64, 48, 40, 20
COLORS = ["#1f5fa8", "#c0561a"]


def decades(values):
    return math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)


def label(power):
    for unit, name in ((9, "G"), (6, "M"), (3, "k")):
        if power >= unit:
            return "%d %s" % (10 ** (power - unit), name)
    return "%g" % 10.0 ** power


def text(x, y, words, anchor="middle", color="#333"):
    return '<text x="%.1f" y="%.1f" text-anchor="%s" fill="%s">%s</text>' % (x, y, anchor, color, words)


def panel(content, left):
    points = [p for curve in content["curves"].values() for p in curve]
    (x0, x1), (y0, y1) = decades([p[0] for p in points]), decades([p[1] for p in points])
    across, down = PANEL - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def at(x, y):
        return (left + LEFT + across * (math.log10(x) - x0) / (x1 - x0),
                TOP + down * (1 - (math.log10(y) - y0) / (y1 - y0)))

    parts = []
    for power in range(x0, x1 + 1):
        x = at(10.0 ** power, 10.0 ** y0)[0]
        parts.append('<path d="M%.1f %d V%d" stroke="#ddd"/>' % (x, TOP, TOP + down))
        parts.append(text(x, TOP + down + 18, label(power)))
    for power in range(y0, y1 + 1):
        y = at(10.0 ** x0, 10.0 ** power)[1]
        parts.append('<path d="M%d %.1f H%d" stroke="#ddd"/>' % (left + LEFT, y, left + LEFT + across))
        parts.append(text(left + LEFT - 8, y + 4, label(power), "end"))
    parts.append(text(left + LEFT + across / 2, HEIGHT - 8, content["title"]))
    parts.append(text(left + LEFT, TOP - 24, content["unit"], "start"))
    for i, (name, curve) in enumerate(content["curves"].items()):
        places = ["%.1f %.1f" % at(*p) for p in curve]
        parts.append('<path d="M%s" fill="none" stroke="%s" stroke-width="2"/>' %
                     (" L".join(places), COLORS[i]))
        parts += ['<circle cx="%s" cy="%s" r="3.5" fill="%s"/>' % (*p.split(), COLORS[i]) for p in places]
        parts.append(text(left + LEFT + across, TOP - 24 + 16 * i, name, "end", COLORS[i]))
    return parts


def draw(panels):
    """The panels beside each other: each a title, a unit, and curves of points by their names."""
    parts = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" '
             'font-size="12">' % (PANEL * len(panels), HEIGHT),
             '<rect width="100%" height="100%" fill="#fff"/>']
    for i, content in enumerate(panels):
        parts += panel(content, PANEL * i)
    return "\n".join(parts + ["</svg>", ""])
