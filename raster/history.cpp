#include "raster/history.h"

#include <algorithm>
#include <map>
#include <utility>

#include "raster/check.h"
#include "raster/looked_up.h"
#include "raster/pixel_box.h"
#include "raster/trace_draw.h"
#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// The values of one pixel in whatever buffers passes go to.
class Pixel {
 public:
  Pixel(int x, int y) : x_(x), y_(y) {}

  /// A buffer that is met for the first time has its value read.
  PixelValues read(const Targets& targets) {
    PixelValues out;
    if (targets.color) out.color = value(colors_, *targets.color);
    if (targets.depth) out.depth = value(depths_, *targets.depth);
    if (targets.stencil) out.stencil = value(stencils_, *targets.stencil);
    return out;
  }

  void write(const Targets& targets, const PixelValues& values) {
    if (targets.color) value(colors_, *targets.color) = values.color;
    if (targets.depth) value(depths_, *targets.depth) = values.depth;
    if (targets.stencil) value(stencils_, *targets.stencil) = values.stencil;
  }

 private:
  template <class Buffer, class Value>
  Value& value(std::vector<std::pair<const Buffer*, Value>>& known, const Buffer& buffer) {
    const auto found =
        std::ranges::find(known, &buffer, [](const auto& entry) { return entry.first; });
    if (found != known.end()) return found->second;
    return known.emplace_back(&buffer, buffer.at(x_, y_)).second;
  }

  int x_, y_;
  std::vector<std::pair<const ColorBuffer*, glm::vec4>> colors_;
  std::vector<std::pair<const DepthBuffer*, std::uint32_t>> depths_;
  std::vector<std::pair<const StencilBuffer*, std::uint8_t>> stencils_;
};

/// Buffers in groups: those of one pass belong together (a union-find forest).
class LinkedBuffers {
 public:
  void link(const Targets& targets) {
    const void* first = group_of(targets);
    for (const void* buffer :
         {static_cast<const void*>(targets.color), static_cast<const void*>(targets.depth),
          static_cast<const void*>(targets.stencil)})
      if (buffer) parents_[root_of(buffer)] = first;
  }
  /// One buffer that stands for the group of a pass's.
  const void* group_of(const Targets& targets) {
    return root_of(targets.color   ? static_cast<const void*>(targets.color)
                   : targets.depth ? static_cast<const void*>(targets.depth)
                                   : static_cast<const void*>(targets.stencil));
  }

 private:
  const void* root_of(const void* buffer) {
    const void** parent = &parents_.try_emplace(buffer, buffer).first->second;
    while (*parent != buffer) {
      const void** above = &parents_.at(*parent);
      // Every other buffer on the way is hung higher.
      *parent = *above;
      buffer = *parent;
      parent = &parents_.at(buffer);
    }
    return buffer;
  }

  std::map<const void*, const void*> parents_;
};

bool share(const Targets& a, const Targets& b) {
  return (a.color && a.color == b.color) || (a.depth && a.depth == b.depth) ||
         (a.stencil && a.stencil == b.stencil);
}

bool holds(const std::optional<Rect>& scissor, int x, int y) {
  return !scissor ||
         (x >= scissor->x && y >= scissor->y && x < std::int64_t{scissor->x} + scissor->width &&
          y < std::int64_t{scissor->y} + scissor->height);
}

bool looks_up(const Command& command) {
  bool found = false;
  for_each_map(command, [&](const DepthBuffer*) { found = true; });
  return found;
}

class Historian {
 public:
  Historian(const Frame& frame, int x, int y, const HistoryOptions& options)
      : frame_(frame), options_(options), x_(x), y_(y), pixel_(x, y) {}

  PixelHistory run(const Targets& asked) {
    PixelHistory out{x_, y_, {}};
    const std::vector<bool> followed = passes_linked_with(asked);
    // Whatever buffer a pass brings in is read before anything is drawn.
    for (std::size_t p = 0; p < followed.size(); ++p)
      if (followed[p]) pixel_.read(frame_.passes()[p].targets);
    std::size_t number = 0;
    for (std::size_t p = 0; p < followed.size(); ++p) {
      const Pass& pass = frame_.passes()[p];
      const bool is_asked = share(pass.targets, asked);
      for (const Command& command : pass.commands) {
        if (number >= options_.commands) break;
        if (followed[p]) follow(pass, p, command, number, is_asked, out);
        ++number;
      }
    }
    execute_to(std::min(options_.commands, frame_.command_count()));
    return out;
  }

 private:
  /// Those that share a buffer with the targets, or with a pass that does, and so on: what they
  /// leave at the pixel may decide what is drawn into the targets.
  std::vector<bool> passes_linked_with(const Targets& asked) const {
    LinkedBuffers buffers;
    for (const Pass& pass : frame_.passes()) buffers.link(pass.targets);
    std::vector<bool> linked;
    for (const Pass& pass : frame_.passes())
      linked.push_back(buffers.group_of(pass.targets) == buffers.group_of(asked));
    return linked;
  }

  void execute_to(std::size_t command) {
    if (command <= executed_) return;
    execute(frame_, {.threads = options_.threads, .first_command = executed_, .commands = command});
    executed_ = command;
  }

  /// Does to the pixel what the command does, and tells of it if it is asked about.
  void follow(const Pass& pass, std::size_t p, const Command& command, std::size_t number,
              bool is_asked, PixelHistory& out) {
    // A map may have been drawn by any command before.
    if (looks_up(command)) execute_to(number);
    CommandRecord record{.pass = p, .command = number, .before = pixel_.read(pass.targets)};
    record.after = record.before;
    const bool touched =
        std::visit([&](const auto& c) { return this->touch(c, pass.targets, record); }, command);
    if (!touched) return;
    pixel_.write(pass.targets, record.after);
    if (is_asked) out.commands.push_back(std::move(record));
  }

  bool touch(const Clear& clear, const Targets& targets, CommandRecord& record) const {
    if (!holds(clear.scissor, x_, y_)) return false;
    PixelValues& after = record.after;
    if (clear.color)
      after.color =
          stored_color(targets.color->format(), {clear.color_write, {}}, *clear.color, after.color);
    if (clear.depth && clear.depth_write)
      after.depth = float_to_depth(*clear.depth, targets.depth->format());
    if (clear.stencil)
      after.stencil = static_cast<std::uint8_t>((after.stencil & ~clear.stencil_write_mask) |
                                                (*clear.stencil & clear.stencil_write_mask));
    return true;
  }

  bool touch(const Blit& blit, const Targets& targets, CommandRecord& record) const {
    const Rect image{blit.x, blit.y, blit.image.width, blit.image.height};
    if (!holds(image, x_, y_) || !holds(blit.scissor, x_, y_)) return false;
    const std::uint8_t* c = blit.image.pixel(x_ - blit.x, y_ - blit.y);
    const Rgba8 source{c[0], c[1], c[2], blit.image.channels == 4 ? c[3] : std::uint8_t{0}};
    record.after.color = stored_color(targets.color->format(), {blit.color_write, {}},
                                      to_floats(source), record.after.color);
    return true;
  }

  bool touch(const Draw& draw, const Targets& targets, CommandRecord& record) const {
    const DrawTrace trace(draw, targets);
    trace.for_each_fragment({x_, y_, x_ + 1, y_ + 1}, [&](const TracedFragment& fragment) {
      FragmentRecord told{.triangle = fragment.triangle_number(),
                          .front_facing = fragment.triangle->front_facing,
                          .depth = fragment.depth,
                          .before = record.after};
      told.outcome = trace.apply(fragment, record.after);
      told.stencil_op = trace.stencil_op(told.front_facing, told.outcome);
      told.after = record.after;
      record.fragments.push_back(told);
    });
    return !record.fragments.empty();
  }

  const Frame& frame_;
  const HistoryOptions& options_;
  const int x_, y_;
  Pixel pixel_;
  std::size_t executed_ = 0;
};

}  // namespace

PixelHistory history(const Frame& frame, int x, int y, const HistoryOptions& options) {
  require(!frame.passes().empty(), "a frame with a history has a pass");
  const std::size_t pass = options.pass.value_or(frame.passes().size() - 1);
  require(pass < frame.passes().size(), "a history's pass is one of the frame's");
  const Targets& asked = frame.passes()[pass].targets;
  require(x >= 0 && y >= 0 && x < asked.width() && y < asked.height(),
          "a history's pixel lies inside its targets");
  return Historian(frame, x, y, options).run(asked);
}

}  // namespace gnomon::raster
