#include "suite.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace gnomon::peer {

namespace {

/// Of the kind grid: few enough that a difference is seldom painted over.
constexpr std::size_t kCommandsALook = 5;

std::optional<Disagreement> run_exact(const OsmesaContext& context, const Case& tried,
                                      std::size_t commands_a_look, Tally& tally) {
  const Comparison comparison = compare_on_opengl(context, tried, commands_a_look);
  tally.pixels += comparison.looks * static_cast<std::size_t>(tried.width) *
                  static_cast<std::size_t>(tried.height);
  tally.differing += comparison.differing;
  return comparison.first;
}

/// What one command did; nullopt if nothing is wrong with it.
std::optional<Disagreement> run_command(const OsmesaContext& context, Recording& recording,
                                        std::size_t command, const Buffers& before, Buffers& theirs,
                                        Tally& tally) {
  const raster::Pass& pass = recording.pass(command);
  recording.execute(command, command + 1);
  replay(context, pass, &recording.color());
  const Buffers ours = recording.read();
  theirs = read_back(context);
  tally.pixels += ours.stencil.size();
  const Differing differing = compare(ours, theirs);
  if (differing.all() == 0) return std::nullopt;
  tally.differing += differing;
  recording.write(theirs);
  const raster::Draw* draw = std::get_if<raster::Draw>(&pass.commands.front());
  if (!draw) {
    tally.causes.unexplained += differing;
    return first_difference(ours, theirs, recording.width(), command + 1);
  }
  const DrawExplanation explanation =
      explain_draw(*draw, pass.targets,
                   {before, ours, theirs, recording.width(), recording.height(),
                    context.is_llvmpipe() ? Driver::llvmpipe : Driver::softpipe});
  tally.causes += explanation.causes;
  if (!explanation.unexplained_pixel) return std::nullopt;
  const std::size_t pixel = *explanation.unexplained_pixel;
  return Disagreement{command + 1, static_cast<int>(pixel) % recording.width(),
                      static_cast<int>(pixel) / recording.width(), values_at(ours, theirs, pixel)};
}

std::optional<Disagreement> run_explained(const OsmesaContext& context, const Case& tried,
                                          Tally& tally) {
  Recording recording(tried);
  reset(context);
  std::optional<Disagreement> first;
  Buffers before = recording.read(), theirs;
  for (std::size_t i = 0; i < tried.commands.size(); ++i) {
    const std::optional<Disagreement> found =
        run_command(context, recording, i, before, theirs, tally);
    if (!first) first = found;
    std::swap(before, theirs);
  }
  return first;
}

/// softpipe's fill rule and rounding are others, so its grid is explained too.
bool explained(Kind kind, bool is_llvmpipe) {
  return kind == Kind::free || (kind == Kind::grid && !is_llvmpipe);
}

struct Row {
  const char* name;
  Differing values;
};

std::array<Row, 7> rows(const DrawCauses& causes) {
  return {{{"snap", causes.snap},
           {"cut", causes.cut},
           {"tie", causes.tie},
           {"plane", causes.plane},
           {"steep", causes.steep},
           {"blend", causes.blend},
           {"unexplained", causes.unexplained}}};
}

void add_row(std::ostream& out, const std::string& name, const Differing& values,
             std::size_t pixels) {
  const auto cell = [&](std::size_t count, std::size_t of) {
    std::ostringstream text;
    text.precision(3);
    text << count << " ("
         << (of > 0 ? 1e6 * static_cast<double>(count) / static_cast<double>(of) : 0.0) << ")";
    out << " | " << text.str()
        << std::string(18 - std::min<std::size_t>(text.str().size(), 18), ' ');
  };
  out << "  " << name << std::string(12 - std::min<std::size_t>(name.size(), 12), ' ');
  cell(values.stencil, pixels);
  cell(values.depth, pixels);
  cell(values.color, 4 * pixels);
  out << "\n";
}

void add_json(std::ostream& out, const char* name, const Differing& values) {
  out << ", \"" << name << "\": {\"stencil\": " << values.stencil << ", \"depth\": " << values.depth
      << ", \"color\": " << values.color << "}";
}

}  // namespace

std::optional<Disagreement> run_case(const OsmesaContext& context, Kind kind, const Case& tried,
                                     Tally& tally) {
  ++tally.frames;
  tally.draws += tried.draws();
  tally.triangles += tried.triangles();
  tally.explained = explained(kind, context.is_llvmpipe());
  if (explained(kind, context.is_llvmpipe())) return run_explained(context, tried, tally);
  return run_exact(context, tried, kind == Kind::grid ? kCommandsALook : 1, tally);
}

std::string table(Kind kind, const Tally& tally) {
  std::ostringstream out;
  out << name(kind) << ": " << tally.frames << " frames, " << tally.draws << " draws, "
      << tally.triangles << " triangles, " << tally.pixels << " pixels compared\n"
      << "  differ (in a million) | stencil bytes    | depths             | colour bytes\n";
  add_row(out, "all", tally.differing, tally.pixels);
  if (tally.explained)
    for (const Row& row : rows(tally.causes)) add_row(out, row.name, row.values, tally.pixels);
  return out.str();
}

std::string json(Kind kind, const Tally& tally, const std::string& renderer) {
  std::ostringstream out;
  out << "{\"renderer\": \"" << renderer << "\", \"kind\": \"" << name(kind)
      << "\", \"frames\": " << tally.frames << ", \"draws\": " << tally.draws
      << ", \"triangles\": " << tally.triangles << ", \"pixels\": " << tally.pixels;
  add_json(out, "differing", tally.differing);
  if (tally.explained)
    for (const Row& row : rows(tally.causes)) add_json(out, row.name, row.values);
  out << "}\n";
  return out.str();
}

}  // namespace gnomon::peer
