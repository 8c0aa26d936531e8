// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Preloaded into a program of many ranks: how much processor time each of its ranks and threads
// works. Ranks that share cores wait for each other in MPI by asking again and again: that time is
// taken off. A rank adds one line to the file that GRANFLUX_RANK_WORK names:
//   rank, seconds of the first thread outside of what waits, seconds of each other thread

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <mpi.h>
#include <unistd.h>

namespace {

double waited = 0; // by the first thread, the only one that calls MPI

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

class Wait {
public:
  Wait() : begin_(processor_seconds()) {}
  ~Wait() { waited += processor_seconds() - begin_; }
  Wait(const Wait&) = delete;
  Wait& operator=(const Wait&) = delete;

private:
  double begin_;
};

void report() {
  const char* const name = std::getenv("GRANFLUX_RANK_WORK");
  if (!name)
    return;
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::ostringstream line;
  line << rank << ' ' << processor_seconds() - waited;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    if (task.path().filename() != std::to_string(getpid())) {
      double nanoseconds = 0;
      std::ifstream(task.path() / "schedstat") >> nanoseconds;
      line << ' ' << 1e-9 * nanoseconds;
    }
  line << '\n';
  std::ofstream(name, std::ios::app) << line.str() << std::flush; // one write: lines stay whole
}

} // namespace

extern "C" {

int MPI_Wait(MPI_Request* a, MPI_Status* b) {
  const Wait wait;
  return PMPI_Wait(a, b);
}
int MPI_Waitall(int a, MPI_Request* b, MPI_Status* c) {
  const Wait wait;
  return PMPI_Waitall(a, b, c);
}
int MPI_Waitany(int a, MPI_Request* b, int* c, MPI_Status* d) {
  const Wait wait;
  return PMPI_Waitany(a, b, c, d);
}
int MPI_Send(const void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f) {
  const Wait wait;
  return PMPI_Send(a, b, c, d, e, f);
}
int MPI_Recv(void* a, int b, MPI_Datatype c, int d, int e, MPI_Comm f, MPI_Status* g) {
  const Wait wait;
  return PMPI_Recv(a, b, c, d, e, f, g);
}
int MPI_Sendrecv(const void* a, int b, MPI_Datatype c, int d, int e, void* f, int g, MPI_Datatype h,
                 int i, int j, MPI_Comm k, MPI_Status* l) {
  const Wait wait;
  return PMPI_Sendrecv(a, b, c, d, e, f, g, h, i, j, k, l);
}
int MPI_Barrier(MPI_Comm a) {
  const Wait wait;
  return PMPI_Barrier(a);
}
int MPI_Bcast(void* a, int b, MPI_Datatype c, int d, MPI_Comm e) {
  const Wait wait;
  return PMPI_Bcast(a, b, c, d, e);
}
int MPI_Allreduce(const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, MPI_Comm f) {
  const Wait wait;
  return PMPI_Allreduce(a, b, c, d, e, f);
}
int MPI_Reduce(const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, int f, MPI_Comm g) {
  const Wait wait;
  return PMPI_Reduce(a, b, c, d, e, f, g);
}
int MPI_Scan(const void* a, void* b, int c, MPI_Datatype d, MPI_Op e, MPI_Comm f) {
  const Wait wait;
  return PMPI_Scan(a, b, c, d, e, f);
}
int MPI_Allgather(const void* a, int b, MPI_Datatype c, void* d, int e, MPI_Datatype f,
                  MPI_Comm g) {
  const Wait wait;
  return PMPI_Allgather(a, b, c, d, e, f, g);
}
int MPI_Gather(const void* a, int b, MPI_Datatype c, void* d, int e, MPI_Datatype f, int g,
               MPI_Comm h) {
  const Wait wait;
  return PMPI_Gather(a, b, c, d, e, f, g, h);
}
int MPI_Finalize() {
  report();
  return PMPI_Finalize();
}

} // extern "C"
