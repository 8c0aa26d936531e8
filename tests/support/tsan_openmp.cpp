// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The thread sanitizer learns from this what waits for what in OpenMP.
//
// g++'s libgomp is not built for the sanitizer, which therefore sees a race wherever two threads
// meet at a barrier. Programs built for the sanitizer call the functions below instead; each tells
// what it orders and calls libgomp's own (names and arguments: libgomp manual, "The libgomp ABI").

#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>

namespace {

using Work = void (*)(void*);

/// One parallel region: places that the sanitizer takes for locks.
struct Region {
  Work work;
  void* data;
  char begun, ended;
  // Barriers take turns: who waits for one may not learn what others did on their way to the next.
  char barrier[2];
};

thread_local Region* region = nullptr;
thread_local unsigned barriers_passed = 0;

template <class Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void work_in_region(void* argument) {
  auto* const mine = static_cast<Region*>(argument);
  Region* const outer = region;
  const unsigned outer_barriers = barriers_passed;
  region = mine;
  barriers_passed = 0;
  __tsan_acquire(&mine->begun);
  mine->work(mine->data);
  __tsan_release(&mine->ended);
  region = outer;
  barriers_passed = outer_barriers;
}

void wait_for_all(void (*wait)()) {
  if (!region) {
    wait();
    return;
  }
  char* const place = &region->barrier[barriers_passed++ % 2];
  __tsan_release(place);
  wait();
  __tsan_acquire(place);
}

} // namespace

extern "C" {

void GOMP_parallel(Work work, void* data, unsigned threads, unsigned flags) {
  static auto* const real = next<void(Work, void*, unsigned, unsigned)>("GOMP_parallel");
  Region mine{work, data, 0, 0, {0, 0}};
  __tsan_release(&mine.begun);
  real(work_in_region, &mine, threads, flags);
  __tsan_acquire(&mine.ended);
}

void GOMP_barrier() {
  static auto* const real = next<void()>("GOMP_barrier");
  wait_for_all(real);
}

/// The end of a loop whose parts threads take as they come.
void GOMP_loop_end() {
  static auto* const real = next<void()>("GOMP_loop_end");
  wait_for_all(real);
}

void GOMP_critical_name_start(void** name) {
  static auto* const real = next<void(void**)>("GOMP_critical_name_start");
  real(name);
  __tsan_acquire(name);
}

void GOMP_critical_name_end(void** name) {
  static auto* const real = next<void(void**)>("GOMP_critical_name_end");
  __tsan_release(name);
  real(name);
}

static char atomic_section;

void GOMP_atomic_start() {
  static auto* const real = next<void()>("GOMP_atomic_start");
  real();
  __tsan_acquire(&atomic_section);
}

void GOMP_atomic_end() {
  static auto* const real = next<void()>("GOMP_atomic_end");
  __tsan_release(&atomic_section);
  real();
}

} // extern "C"
