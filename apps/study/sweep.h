// A way of failing, swept from harmless to hopeless: every method on the same inputs.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace gnomon::apps::study {

/// What a method did on one input, or on several in sum.
struct Outcome {
  /// How much of it is wrong, in the unit that SweepText::measure names: pixels, frames.
  double wrong = 0.0, of = 0.0;
  /// Channels of buffers that are not finite, of which there should be none.
  std::size_t not_finite = 0;

  double share() const { return of > 0.0 ? wrong / of : 0.0; }
  bool operator==(const Outcome&) const = default;
};

struct SweepText {
  /// Short and plain, for the command line: "near-plane".
  std::string name;
  /// What fails, in a few words; and in a sentence or two what is done.
  std::string title, explanation;
  /// What is swept, with its unit; what is counted ("wrong pixels of those the light reaches"); and
  /// by which oracle.
  std::string parameter, measure, oracle;
  bool operator==(const SweepText&) const = default;
};

class Sweep {
 public:
  virtual ~Sweep() = default;
  virtual SweepText text() const = 0;
  /// The parameter's values, from harmless to hopeless, as they are shown.
  virtual std::vector<std::string> values() const = 0;
  virtual std::vector<std::string> methods() const = 0;
  /// Different inputs a value.
  virtual std::size_t inputs() const = 0;
  /// One outcome a method. The same in any order of calls and for any number of threads.
  virtual std::vector<Outcome> run(std::size_t value, std::size_t input) = 0;
};

}  // namespace gnomon::apps::study
