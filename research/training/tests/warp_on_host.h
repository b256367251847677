/* Runs a kernel on the processor, one warp a block: lanes take turns and change where they synchronise. */
#include <stdbool.h>
#include <stdlib.h>
#include <ucontext.h>

#define __global__
#define __shared__ static
#define __syncwarp next_lane
#define __shfl_xor_sync(mask, value, step) _Generic((value), float: shuffled_float, int: shuffled_int)(value, step)

enum { WARP = 32, STACK = 1 << 16 };
struct index {
  int x;
};
static struct index blockIdx, threadIdx, blockDim = {WARP};
static ucontext_t scheduler, lanes[WARP];
static bool done[WARP];
static float floats[WARP];
static int ints[WARP];

static void next_lane(void) { swapcontext(&lanes[threadIdx.x], &scheduler); }

static float shuffled_float(float value, int step) {
  floats[threadIdx.x] = value;
  next_lane();
  float other = floats[threadIdx.x ^ step];
  next_lane();
  return other;
}

static int shuffled_int(int value, int step) {
  ints[threadIdx.x] = value;
  next_lane();
  int other = ints[threadIdx.x ^ step];
  next_lane();
  return other;
}

void assign_rows(const float *, const long long *, long long *, int, int, int);

static struct {
  const float *costs;
  const long long *rows;
  long long *columns_of;
  int problems, most, columns;
} given;

static void run_lane(void) {
  assign_rows(given.costs, given.rows, given.columns_of, given.problems, given.most, given.columns);
  done[threadIdx.x] = true;
  next_lane();
}

void assign_on_host(const float *costs, const long long *rows, long long *columns_of, int problems, int most,
                    int columns) {
  char *stacks = malloc((size_t)WARP * STACK);
  given.costs = costs, given.rows = rows, given.columns_of = columns_of;
  given.problems = problems, given.most = most, given.columns = columns;
  for (blockIdx.x = 0; blockIdx.x < problems; blockIdx.x++) {
    for (int lane = 0; lane < WARP; lane++) {
      done[lane] = false;
      getcontext(&lanes[lane]);
      lanes[lane].uc_stack.ss_sp = stacks + (size_t)lane * STACK;
      lanes[lane].uc_stack.ss_size = STACK;
      makecontext(&lanes[lane], run_lane, 0);
    }
    for (bool going = true; going;) {
      going = false;
      for (threadIdx.x = 0; threadIdx.x < WARP; threadIdx.x++) {
        if (done[threadIdx.x]) continue;
        going = true;
        swapcontext(&scheduler, &lanes[threadIdx.x]);
      }
    }
  }
  free(stacks);
}
