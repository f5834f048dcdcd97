// The worker's side of worker.h.
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <malloc.h>
#include <unistd.h>

#include "bench/worker.h"

namespace gnomon::bench {
namespace {

std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0, resident_pages = 0;
  statm >> pages >> resident_pages;
  return resident_pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Of this program's own memory: getrusage's figure would begin with the parent's.
std::size_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
  }
  throw std::runtime_error("/proc/self/status has no VmHWM");
}

/// Freed memory stays with the process: Mesa allocates and frees its bins every frame, and what it
/// would be charged for otherwise is the kernel's clearing of pages.
void keep_freed_memory() {
  constexpr int kMuch = 1 << 30;
  mallopt(M_TRIM_THRESHOLD, kMuch);
  mallopt(M_MMAP_THRESHOLD, kMuch);
  mallopt(M_TOP_PAD, 64 << 20);
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::string answer_frame(Runner& runner) {
  std::ostringstream out;
  for (const std::optional<double>& time : runner.frame()) {
    out << ' ';
    if (time) {
      out << *time;
    } else {
      out << '-';
    }
  }
  return out.str().substr(1);
}

std::string answer_hashes(Runner& runner) {
  std::string out;
  for (const std::string& hash : runner.hashes()) out += hash + ";";
  return out;
}

}  // namespace

int serve(const std::string& subject, Size size, std::span<const std::filesystem::path> models,
          const Task& task) {
  keep_freed_memory();
  try {
    const Subject loaded_subject = make_subject(subject, size, models);
    const std::size_t loaded = resident_bytes();
    const std::unique_ptr<Runner> runner = make_runner(loaded_subject, task);
    for (std::string question; std::getline(std::cin, question);) {
      if (question == "frame") {
        std::cout << "ok " << answer_frame(*runner) << std::endl;
      } else if (question == "hashes") {
        std::cout << "ok " << answer_hashes(*runner) << std::endl;
      } else if (question == "memory") {
        std::cout << "ok " << loaded << ' ' << peak_bytes() << std::endl;
      } else if (question == "picture") {
        const Picture picture = runner->picture();
        std::cout << "ok " << picture.size() << '\n';
        std::cout.write(reinterpret_cast<const char*>(picture.data()),
                        static_cast<std::streamsize>(picture.size()));
        std::cout.flush();
      } else {
        std::cout << "error it does not understand '" << question << "'" << std::endl;
      }
    }
    return 0;
  } catch (const std::exception& error) {
    std::cout << "error " << one_line(error.what()) << std::endl;
    return 1;
  }
}

}  // namespace gnomon::bench
