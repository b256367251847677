"""Exact minimum-cost assignment of a whole batch at once, on any device.

Shortest augmenting paths with potentials (Jonker and Volgenant 1987, in the form of Crouse 2016): rows join one by one,
each along the cheapest path to a free column; every step is done for all problems together.
"""

from importlib.util import find_spec

import torch

from .gpu import assignment


@torch.no_grad()
def assign(cost: torch.Tensor, rows: torch.Tensor) -> torch.Tensor:
    """Column of each row, [batch, most], such that the sum of costs is least; -1 for rows that do not exist.

    `cost` is [batch, most, columns] and finite with at least as many columns as rows; `rows` [batch] says how many
    of the rows exist in each problem. On a GPU that CuPy can compile for, a kernel of its own does it.
    """
    if cost.is_cuda and find_spec("cupy") is not None:
        return assignment.assign(cost, rows)
    batch, most, columns = cost.shape
    if most > columns:
        raise ValueError(f"{most} rows cannot be assigned to {columns} columns")
    device = cost.device
    cost = cost.double()
    exists = torch.arange(most, device=device) < rows.unsqueeze(1)
    # A row at its cheapest column is optimal as long as no other row wants that column.
    row_potential, cheapest = cost.min(2)
    column_potential = torch.zeros(batch, columns, dtype=cost.dtype, device=device)
    row_of = torch.full((batch, columns + 1), most, device=device)
    wanted = torch.where(exists, cheapest, columns)
    order = torch.arange(most, device=device).expand(batch, most)
    row_of = row_of.scatter_reduce(1, wanted, order, "amin")[:, :columns]
    column_of = torch.where(exists & (row_of.gather(1, cheapest) == order), cheapest, -1)
    row_of = torch.where(row_of == most, -1, row_of)
    while True:
        waiting = exists & (column_of < 0)
        every = torch.nonzero(waiting.any(1)).flatten()
        if len(every) == 0:
            return column_of
        row = waiting[every].int().argmax(1)
        sink, path, length, reached, visited, shortest = _search(
            cost[every], row, row_potential[every], column_potential[every], row_of[every]
        )
        gain = torch.where(reached, length.unsqueeze(1) - shortest, 0)
        column_potential[every] -= gain
        # A visited row but the new one was entered through its own column.
        own = column_of[every]
        row_potential[every] += torch.where(visited & (own >= 0), gain.gather(1, own.clamp_min(0)), 0)
        row_potential[every, row] += length
        _augment(every, row, sink, path, column_of, row_of)


def _search(cost, row, row_potential, column_potential, row_of):
    """Dijkstra's search for the cheapest path from `row` to a free column, in each problem."""
    batch, most, columns = cost.shape
    device = cost.device
    index = torch.arange(batch, device=device)
    shortest = torch.full((batch, columns), torch.inf, dtype=cost.dtype, device=device)
    path = torch.full((batch, columns), -1, device=device)
    reached = torch.zeros(batch, columns, dtype=torch.bool, device=device)
    visited = torch.zeros(batch, most, dtype=torch.bool, device=device)
    length = torch.zeros(batch, dtype=cost.dtype, device=device)
    sink = torch.full((batch,), -1, device=device)
    at = row
    while True:
        searching = sink < 0
        visited[index, at] |= searching
        through = cost[index, at] + (length - row_potential[index, at]).unsqueeze(1) - column_potential
        better = (through < shortest) & ~reached & searching.unsqueeze(1)
        shortest = torch.where(better, through, shortest)
        path = torch.where(better, at.unsqueeze(1), path)
        least, column = shortest.masked_fill(reached, torch.inf).min(1)
        length = torch.where(searching, least, length)
        reached[index, column] |= searching
        owner = row_of[index, column]
        sink = torch.where(searching & (owner < 0), column, sink)
        at = torch.where(searching & (owner >= 0), owner, at)
        if not (sink < 0).any():
            return sink, path, length, reached, visited, shortest


def _augment(every, row, sink, path, column_of, row_of):
    """Turns each path from its free column back to the new row around."""
    column = sink
    index = torch.arange(len(every), device=every.device)
    while len(index) > 0:
        by = path[index, column]
        problem = every[index]
        row_of[problem, column] = by
        before = column_of[problem, by]
        column_of[problem, by] = column
        going = by != row[index]
        index, column = index[going], before[going]
