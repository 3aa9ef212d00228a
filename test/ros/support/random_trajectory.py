# SPDX-License-Identifier: Apache-2.0
"""Random trajectories of outputs that are on or off, as planners make them: some stops, and many points on straight lines between."""
import random

BETWEEN = 50  # points
SWITCHES = 0.5  # position: the output is on above it
CLEAR = 0.05  # of it: a line that ends there switches, or does not


class RandomTrajectories:
    def __init__(self, joints, seed, *, stops=4, step=(0.15, 0.4), apart=0):
        """`stops`: at most; `step`: least and most seconds between two; `apart`: least seconds between two edges of a joint."""
        self._joints, self._stops, self._step, self._apart = joints, stops, step, apart
        self._random = random.Random(seed)
        self._levels = dict.fromkeys(joints, 0)

    def next(self):
        """The points, each a time and positions; and the edges that they make: (joint, level, time)."""
        while True:
            count, step = self._random.randint(2, self._stops), self._random.uniform(*self._step)
            stops = [[self._position() for _ in self._joints] for _ in range(count)]
            edges, levels = self._edges(stops, step)
            times = ([at for name, _, at in edges if name == joint] for joint in self._joints)
            if all(later - at >= self._apart for each in times for at, later in zip(each, each[1:])):
                break
        self._levels = levels
        points = [(0.0, *stops[0])]
        for number, (start, end) in enumerate(zip(stops, stops[1:])):
            for i in range(1, BETWEEN + 1):
                points.append((step * (number + i / BETWEEN), *(a + (b - a) * i / BETWEEN for a, b in zip(start, end))))
        return points, sorted(edges, key=lambda edge: edge[2])

    def _position(self):
        position = self._random.random()
        return position if abs(position - SWITCHES) > CLEAR else 1.0

    def _edges(self, stops, step):
        edges, levels = [], dict(self._levels)
        for joint, positions in zip(self._joints, zip(*stops)):
            crossings = [(0, positions[0])]
            for number, (a, b) in enumerate(zip(positions, positions[1:])):
                crossings.append((step * (number + (SWITCHES - a) / (b - a if a != b else 1)), b))
            for at, position in crossings:
                level = int(position > SWITCHES)
                if level != levels[joint]:
                    edges.append((joint, level, at))
                levels[joint] = level
        return edges, levels


def lateness(joints, seen, wanted):
    """How late each edge was seen. Each of `wanted`, (joint, level, time), has to be in `seen` once, a joint's in their order."""
    late = []
    for joint in joints:
        edges, expected = ([edge for edge in some if edge[0] == joint] for some in (seen, wanted))
        if [level for _, level, _ in edges] != [level for _, level, _ in expected]:
            raise AssertionError(f"{joint}: seen {edges}, wanted {expected}")
        late += [at - due for (*_, at), (*_, due) in zip(edges, expected)]
    return late


def described(late):
    """Some numbers about seconds, in milliseconds."""
    late = sorted(1000 * each for each in late)
    return f"least {late[0]:.3f}, median {late[len(late) // 2]:.3f}, p99 {late[int(0.99 * len(late))]:.3f}, max {late[-1]:.3f}"
