// How far a long run has come, on a terminal's last line only.
#pragma once

#include <cstdint>
#include <optional>

namespace gnomon::apps {

class Progress {
 public:
  /// What is counted ("frame") and how many there will be, if that is known.
  Progress(const char* what, std::optional<std::int64_t> total);
  /// Takes the line away.
  ~Progress();
  void show(std::int64_t done) const;

 private:
  const char* what_;
  std::optional<std::int64_t> total_;
  bool shown_;
};

}  // namespace gnomon::apps
