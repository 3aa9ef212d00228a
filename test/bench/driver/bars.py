# SPDX-License-Identifier: Apache-2.0
"""A bar chart as SVG: groups of bars, one colour a side."""
from xml.sax.saxutils import escape

COLOURS = ("#3465a4", "#bbbbbb", "#c17d11", "#555753")
BAR, GAP, LEFT, WIDTH = 16, 14, 230, 420


def draw(title, sides, rows, unit):
    """rows: (name, one figure for each side)."""
    largest = max(figure for _, figures in rows for figure in figures) or 1
    height = 60 + len(rows) * (len(sides) * BAR + GAP) + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 100}" height="{height}" '
           'font-family="sans-serif" font-size="12">',
           '<rect width="100%" height="100%" fill="white"/>',
           f'<text x="10" y="20" font-size="14">{escape(title)}</text>']
    for index, side in enumerate(sides):
        x = 10 + index * 180
        out.append(f'<rect x="{x}" y="30" width="12" height="12" fill="{COLOURS[index]}"/>'
                   f'<text x="{x + 18}" y="41">{escape(side)}</text>')
    y = 60
    for name, figures in rows:
        out.append(f'<text x="{LEFT - 8}" y="{y + len(sides) * BAR / 2 + 4}" text-anchor="end">{escape(name)}</text>')
        for index, figure in enumerate(figures):
            width = WIDTH * figure / largest
            out.append(f'<rect x="{LEFT}" y="{y}" width="{width:.1f}" height="{BAR - 2}" fill="{COLOURS[index]}"/>'
                       f'<text x="{LEFT + width + 4:.1f}" y="{y + BAR - 5}">{figure:.4g} {unit}</text>')
            y += BAR
        y += GAP
    out.append("</svg>\n")
    return "\n".join(out)
