#include "apps/inspector/inspection.h"

#include <algorithm>

#include "apps/inspector/frame_json.h"
#include "raster/check.h"
#include "raster/history.h"

namespace gnomon::apps::inspector {

namespace {

/// Most that is kept to go back quickly, in bytes.
constexpr std::size_t kSavedBytes = std::size_t{256} << 20;

std::string text_of(const nlohmann::ordered_json& json) {
  // A label is bytes; those that are no UTF-8 are replaced.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

Inspection::Inspection(std::shared_ptr<const void> owner, const raster::Frame& frame)
    : owner_(std::move(owner)), frame_(frame), buffers_(frame) {
  buffers_.reset();
  std::size_t command = 0;
  for (const raster::Pass& pass : frame.passes()) {
    pass_begins_.push_back(command);
    command += pass.commands.size();
  }
}

void Inspection::run_to(std::size_t commands) {
  while (position_ < commands) {
    std::size_t stop = position_ + 1;
    while (stop < commands && !begins_pass(stop)) ++stop;
    raster::execute(frame_, {.memory = &memory_, .first_command = position_, .commands = stop});
    position_ = stop;
    if (!begins_pass(position_) || (!saved_.empty() && saved_.back().commands >= position_))
      continue;
    if (buffers_.bytes() * (saved_.size() + 1) <= kSavedBytes)
      saved_.push_back({position_, buffers_.save()});
  }
}

void Inspection::seek(std::size_t commands) {
  commands = std::min(commands, frame_.command_count());
  if (commands < position_) {
    const auto after = std::ranges::upper_bound(saved_, commands, {}, &Saved::commands);
    if (after == saved_.begin()) {
      buffers_.reset();
      position_ = 0;
    } else {
      buffers_.restore(std::prev(after)->buffers);
      position_ = std::prev(after)->commands;
    }
  }
  run_to(commands);
}

raster::DrawFates Inspection::fates(std::size_t first, std::size_t last) {
  last = std::min(last, frame_.command_count());
  raster::require(first < last, "fates are asked of one command or more");
  const raster::Targets& targets = place_of(frame_, first).pass->targets;
  raster::DrawFates out(targets.width(), targets.height());
  for (std::size_t command = first; command < last; ++command) {
    const Place place = place_of(frame_, command);
    if (place.pass->targets.width() != out.width || place.pass->targets.height() != out.height)
      continue;
    seek(command);
    raster::add_fates(*place.command, place.pass->targets, out);
  }
  seek(last);
  return out;
}

std::string Inspection::history(std::size_t pass, int x, int y, std::size_t commands) {
  raster::require(pass < frame_.passes().size(), "a history's pass is one of the frame's");
  const raster::Targets& targets = frame_.passes()[pass].targets;
  raster::require(x >= 0 && y >= 0 && x < targets.width() && y < targets.height(),
                  "a history's pixel lies inside its targets");
  const std::size_t back = position_;
  buffers_.reset();
  position_ = 0;
  const raster::PixelHistory told =
      raster::history(frame_, x, y, {.pass = pass, .commands = commands});
  position_ = std::min(commands, frame_.command_count());
  seek(back);
  return text_of(history_json(frame_, told));
}

std::vector<WireEdge> Inspection::wires(std::size_t command) const {
  const Place place = place_of(frame_, command);
  const auto* draw = std::get_if<raster::Draw>(place.command);
  return draw ? wireframe(*draw, place.pass->targets) : std::vector<WireEdge>();
}

std::string Inspection::description(bool in_brief) const {
  return text_of(frame_json(frame_, buffers_, in_brief));
}

}  // namespace gnomon::apps::inspector
