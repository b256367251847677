// Exact minimum-cost assignment by shortest augmenting paths (Jonker and Volgenant 1987), one warp for each problem and
// no message to the host, so that it can be part of a CUDA graph.
//
// Lane l keeps the potentials of columns l, l + 32, ... in registers. The source is valid C too: the tests compile it
// for the processor.

#define LANES 32
#define MOST_ROWS 32
#define COLUMNS_PER_LANE 4
#define WARPS 4
#define INFINITE 3.4e38f
#define EVERY_LANE 0xffffffffu

#ifdef __cplusplus
extern "C"
#endif
__global__ void
assign_rows(const float *costs, const long long *rows, long long *columns_of, int problems, int most, int columns) {
  __shared__ float row_potential[WARPS][MOST_ROWS];
  __shared__ int row_of[WARPS][LANES * COLUMNS_PER_LANE];
  // The column before each column on the cheapest path to it; -1 at the beginning of the path.
  __shared__ int before[WARPS][LANES * COLUMNS_PER_LANE];
  int problem = (blockIdx.x * blockDim.x + threadIdx.x) / LANES;
  int lane = threadIdx.x % LANES, warp = threadIdx.x / LANES;
  if (problem >= problems) return;
  const float *cost = costs + (long long)problem * most * columns;
  float column_potential[COLUMNS_PER_LANE], shortest[COLUMNS_PER_LANE];
  bool reached[COLUMNS_PER_LANE];
  for (int k = 0; k < COLUMNS_PER_LANE; k++) {
    column_potential[k] = 0.0f;
    row_of[warp][lane + LANES * k] = -1;
  }
  row_potential[warp][lane] = 0.0f;
  __syncwarp();

  for (int row = 0; row < (int)rows[problem]; row++) {
    for (int k = 0; k < COLUMNS_PER_LANE; k++) {
      shortest[k] = INFINITE;
      reached[k] = false;
    }
    // Dijkstra's search for the cheapest path from this row to a free column.
    int at = row, column = -1;
    while (at >= 0) {
      float least = INFINITE;
      int nearest = LANES * COLUMNS_PER_LANE;
      float potential = row_potential[warp][at];
      for (int k = 0; k < COLUMNS_PER_LANE; k++) {
        int j = lane + LANES * k;
        if (j >= columns || reached[k]) continue;
        float through = cost[at * columns + j] - potential - column_potential[k];
        if (through < shortest[k]) {
          shortest[k] = through;
          before[warp][j] = column;
        }
        if (shortest[k] < least) {
          least = shortest[k];
          nearest = j;
        }
      }
      for (int step = LANES / 2; step > 0; step /= 2) {
        float other = __shfl_xor_sync(EVERY_LANE, least, step);
        int its_column = __shfl_xor_sync(EVERY_LANE, nearest, step);
        if (other < least || (other == least && its_column < nearest)) {
          least = other;
          nearest = its_column;
        }
      }
      __syncwarp();
      // Lengths count from the column reached last.
      for (int k = 0; k < COLUMNS_PER_LANE; k++) {
        int j = lane + LANES * k;
        if (j >= columns) continue;
        if (reached[k]) {
          row_potential[warp][row_of[warp][j]] += least;
          column_potential[k] -= least;
        } else {
          shortest[k] -= least;
        }
      }
      if (lane == 0) row_potential[warp][row] += least;
      __syncwarp();
      column = nearest;
      if (column % LANES == lane) reached[column / LANES] = true;
      at = row_of[warp][column];
    }
    // Every lane has seen that the column is free before a row takes it.
    __syncwarp();
    // Each row on the path takes the column after its own.
    if (lane == 0) {
      while (before[warp][column] >= 0) {
        row_of[warp][column] = row_of[warp][before[warp][column]];
        column = before[warp][column];
      }
      row_of[warp][column] = row;
    }
    __syncwarp();
  }

  for (int row = lane; row < most; row += LANES) columns_of[(long long)problem * most + row] = -1;
  __syncwarp();
  for (int k = 0; k < COLUMNS_PER_LANE; k++) {
    int j = lane + LANES * k;
    if (j < columns && row_of[warp][j] >= 0) columns_of[(long long)problem * most + row_of[warp][j]] = j;
  }
}
