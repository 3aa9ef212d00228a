# SPDX-License-Identifier: Apache-2.0
"""Histograms as SVG, one above the other on one scale: a side each, so that their shapes can be compared."""
from xml.sax.saxutils import escape

from bars import COLOURS

BINS, BAR, HEIGHT, LEFT, TOP = 80, 8, 130, 20, 40


def draw(title, sides, unit, share=0.995):
    """sides: {name: values}. What is beyond that share of all values is counted in the last bar."""
    values = sorted(value for some in sides.values() for value in some)
    least = values[0]
    width = ((values[int(share * (len(values) - 1))] - least) or 1) / BINS
    height = TOP + len(sides) * (HEIGHT + 30) + 10
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * LEFT + BINS * BAR + 60}" height="{height}" '
           'font-family="sans-serif" font-size="12">',
           '<rect width="100%" height="100%" fill="white"/>',
           f'<text x="10" y="20" font-size="14">{escape(title)}</text>']
    for index, (side, some) in enumerate(sides.items()):
        counts = [0] * (BINS + 1)
        for value in some:
            counts[min(BINS, int((value - least) / width))] += 1
        base = TOP + index * (HEIGHT + 30) + HEIGHT
        out.append(f'<text x="{LEFT + 250}" y="{base - HEIGHT + 12}" fill="{COLOURS[index]}">{escape(side)}, {len(some)} values</text>')
        for place, count in enumerate(counts):
            if count:
                tall = (HEIGHT - 20) * count / max(counts)
                out.append(f'<rect x="{LEFT + place * BAR}" y="{base - tall:.1f}" width="{BAR - 1}" height="{tall:.1f}" '
                           f'fill="{COLOURS[index]}"/>')
        out.append(f'<line x1="{LEFT}" y1="{base}" x2="{LEFT + (BINS + 1) * BAR}" y2="{base}" stroke="black"/>')
        for place in range(0, BINS + 1, BINS // 4):
            anchor = "start" if place == 0 else "middle"
            more = " and more" if place == BINS else ""
            out.append(f'<text x="{LEFT + place * BAR}" y="{base + 14}" text-anchor="{anchor}">{least + place * width:.4g} {unit}{more}</text>')
    out.append("</svg>\n")
    return "\n".join(out)
