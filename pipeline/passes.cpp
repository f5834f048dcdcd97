#include "pipeline/passes.h"

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

bool names(std::string_view label, std::string_view wanted) {
  if (!label.starts_with(wanted)) return false;
  label.remove_prefix(wanted.size());
  return label.empty() || label.starts_with(": ");
}

}  // namespace

std::optional<std::size_t> commands_through(const raster::Frame& frame, std::string_view label) {
  for (std::size_t pass = frame.passes().size(); pass > 0; --pass) {
    if (names(frame.passes()[pass - 1].label, label)) return commands_through_pass(frame, pass - 1);
  }
  return std::nullopt;
}

std::size_t commands_through_pass(const raster::Frame& frame, std::size_t pass) {
  raster::require(pass < frame.passes().size(), "a pass number is below the number of passes");
  std::size_t commands = 0;
  for (std::size_t i = 0; i <= pass; ++i) commands += frame.passes()[i].commands.size();
  return commands;
}

}  // namespace gnomon::pipeline
