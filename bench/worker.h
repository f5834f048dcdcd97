// A system in a process of its own, which draws a frame when it is asked to. Mesa takes its driver
// and its threads from the environment once a process; so all systems have one, and take turns.
// Protocol: a word a line to the worker's standard input; from its standard output a line "ok ..."
// or "error MESSAGE", after "picture" followed by the bytes.
#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "bench/runner.h"

namespace gnomon::bench {

/// Resident memory of a worker's process, in bytes.
struct Memory {
  /// With the scene loaded, before the system has buffers or trees of its own; and the most there
  /// ever was.
  std::size_t loaded = 0, peak = 0;
};

class Worker {
 public:
  /// Starts the process. Throws std::runtime_error when it cannot be started.
  Worker(const std::string& subject, Size size, std::span<const std::filesystem::path> models,
         const Task& task);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  const Task& task() const { return task_; }

  /// As Runner's. Throw std::runtime_error with the worker's own message.
  StageTimes frame();
  Picture picture();
  std::vector<std::string> hashes();
  Memory memory();

 private:
  std::string ask(std::string_view question);

  Task task_;
  std::string what_;
  pid_t process_ = -1;
  std::FILE* to_ = nullptr;
  std::FILE* from_ = nullptr;
};

/// The worker's side: answers until its standard input ends. Returns the exit status.
int serve(const std::string& subject, Size size, std::span<const std::filesystem::path> models,
          const Task& task);

}  // namespace gnomon::bench
