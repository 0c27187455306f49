"""Tables of the rows of `rays`."""

from __future__ import annotations

from bench.core import Row, pick, unique
from bench.statistics import geometric_mean, median, ratio, spread
from bench.tables import Table, figure, times

HEADS = (
    "mesh", "tree", "Komorebi", "Embree MEDIUM, 1 ray", "robust", "best of Embree", "which",
    "/ MEDIUM, 1 ray", "/ robust", "/ best", "SSE4 / best 1 ray", "blocked", "differ",
)  # fmt: skip


def title(kind: str, threads: float) -> str:
    """`ao:16:0.1` in words."""
    name, count, reach = [*kind.split(":"), "", ""][:3]
    what = {
        "ao": f"{count} cosine rays a hit point, "
        + (f"{100 * float(reach):g} % of the diagonal" if reach else "no limit"),
        "map": f"{count} rays a hit point drawn from rooitou_park",
        "camera": "camera rays, closest hit",
    }[name]
    return f"Rays, {what}, {threads:g} thread{'s' if threads > 1 else ''}: million rays a second"


def speed(row: Row) -> str:
    """Million rays a second."""
    return figure(row["ray_count"] / median(row["seconds"]) / 1e6)


def label(row: Row) -> str:
    """A rival's name."""
    return f"{row['tree']} {row['query']}"


def rivals(rows: list[Row]) -> dict[str, Row]:
    """Whom we are compared with, of the rows of one mesh, kind of rays and number of threads:
    MEDIUM and robust MEDIUM trees asked ray by ray, the best single rays, the best of all."""
    embree = pick(rows, engine="embree")
    singles = pick(embree, query="1")
    fastest = sorted(embree, key=lambda row: median(row["seconds"]))
    return {
        "medium": pick(singles, tree="MEDIUM")[0],
        "robust": pick(singles, tree="MEDIUM+ROBUST")[0],
        "single": next(row for row in fastest if row["query"] == "1"),
        "best": fastest[0],
    }


def ray_table(rows: list[Row], kind: str, threads: float) -> Table:
    """One kind of rays on one number of threads; a line a mesh and tree of ours."""
    table = Table(title(kind, threads), list(HEADS))
    means: dict[str, list[list[float]]] = {}
    worst = 0.0
    for mesh in unique(rows, "mesh"):
        here = pick(rows, mesh=mesh)
        them = rivals(here)
        for tree in unique(pick(here, engine="komorebi"), "tree"):
            ours = pick(here, engine="komorebi", tree=tree)
            fast = min(
                (r for r in ours if r["instructions"] == ours[0]["instructions"]),
                key=lambda r: median(r["seconds"]),
            )
            small = pick(ours, instructions="SSE4", query="bundles")
            against = [
                ratio(r["seconds"], fast["seconds"])
                for r in (them["medium"], them["robust"], them["best"])
            ]
            against.append(
                ratio(them["single"]["seconds"], small[0]["seconds"]) if small else float("nan")
            )
            means.setdefault(tree, []).append(against)
            worst = max(
                worst, *(spread(r["seconds"]) for r in (fast, them["medium"], them["best"]))
            )
            table.add(
                mesh, tree, speed(fast), speed(them["medium"]), speed(them["robust"]), speed(them["best"]), label(them["best"]),
                *(times(a) for a in against),
                f"{100 * fast['blocked_share']:.1f} %", f"{1e6 * them['medium']['differing_share']:.0f} ppm",
            )  # fmt: skip
    for tree, list_of in means.items():
        columns = [geometric_mean(list(column)) for column in zip(*list_of, strict=True)]
        table.add("geometric mean", tree, *[""] * 5, *(times(c) for c in columns), "", "")
    table.notes = [f"Largest spread of what is compared: {100 * worst:.0f} %."]
    return table


def ray_tables(rows: list[Row]) -> list[Table]:
    """One table a kind of rays and number of threads."""
    return [
        ray_table(pick(rows, rays=kind, threads=threads), kind, threads)
        for kind in unique(rows, "rays")
        for threads in unique(rows, "threads")
    ]
