// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// main of every test program: all ranks run the same tests, rank 0 reports their course, and each
// rank reports its own failures. The exit code of rank 0 stands for all.

#include <cstdio>
#include <gtest/gtest.h>
#include <mpi.h>
#include <sstream>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace {

/// Prints the failures of one rank as a whole, so that those of several ranks do not mix.
class RankFailures : public testing::EmptyTestEventListener {
public:
  explicit RankFailures(int rank) : rank_(rank) {}

private:
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (!result.failed())
      return;
    std::ostringstream text;
    text << "[rank " << rank_ << "] " << (result.file_name() ? result.file_name() : "unknown file")
         << ':' << result.line_number() << ": Failure\n"
         << result.message() << '\n';
    std::fputs(text.str().c_str(), stderr);
    std::fflush(stderr);
  }
  void OnTestEnd(const testing::TestInfo& info) override {
    if (!info.result()->Failed())
      return;
    std::fprintf(stderr, "[rank %d] FAILED %s.%s\n", rank_, info.test_suite_name(), info.name());
    std::fflush(stderr);
  }
  int rank_;
};

} // namespace

int main(int argc, char** argv) {
  int provided = 0;
#if defined(__SANITIZE_ADDRESS__)
  __lsan_disable(); // what modules of MPI leave behind that it loads, tries and unloads here
#endif
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
#if defined(__SANITIZE_ADDRESS__)
  __lsan_enable();
#endif
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  testing::InitGoogleTest(&argc, argv);

  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (rank != 0) {
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new RankFailures(rank));
  }
  int failed = RUN_ALL_TESTS();
  // A program whose tests were all filtered away has shown nothing.
  if (testing::UnitTest::GetInstance()->test_to_run_count() == 0)
    failed = 1;
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
#if defined(__SANITIZE_ADDRESS__)
  // Now, not at exit: once MPI has unloaded its modules, what it keeps cannot be told from a leak.
  __lsan_do_leak_check();
#endif
  MPI_Finalize();
  // One rank tells mpirun; if all did, it would kill those that still write their failures.
  return rank == 0 ? failed : 0;
}
