// Inspections of frames, lab states and what the program tells of a pixel. Oracles: executing the
// frame, the frame's own data, rays, and the documented contract.
#include <cmath>
#include <map>
#include <random>
#include <set>

#include <nlohmann/json.hpp>

#include "apps/inspector/frame_json.h"
#include "apps/inspector/inspection.h"
#include "apps/inspector/lab_frame.h"
#include "apps/inspector/lab_state.h"
#include "apps/inspector/turn.h"
#include "apps/inspector/wireframe.h"
#include "apps/live_view.h"
#include "ar/frame_file.h"
#include "program.h"
#include "raster/execute.h"
#include "raster/history.h"

namespace gnomon {
namespace {

using namespace apps::inspector;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const fs::path kFrames = GNOMON_SOURCE_DIR "/golden/frames";

std::shared_ptr<raster::RecordedFrame> read(const std::string& name) {
  return std::make_shared<raster::RecordedFrame>(ar::read_frame(kFrames / name));
}

std::vector<std::uint8_t> stencil_after(const std::string& name, std::size_t commands) {
  const auto recorded = read(name);
  raster::execute(recorded->frame, {.commands = commands});
  for (const raster::Buffer& buffer : recorded->buffers)
    if (const auto* stencil = std::get_if<raster::StencilBuffer>(&buffer))
      return stencil->to_rows();
  return {};
}

std::vector<std::uint8_t> stencil_of(const Inspection& inspection) {
  for (std::size_t i = 0; i < inspection.buffers().size(); ++i)
    if (const auto* stencil = std::get_if<raster::StencilBuffer*>(&inspection.buffers()[i]))
      return (*stencil)->to_rows();
  return {};
}

class History : public Program {};
class Inspect : public Program {};
class Lab : public Program {};

TEST(Inspection, SeeksForwardsAndBackwardsToTheSameBytes) {  // oracle: executing so far, anew
  const std::string name = "desk-01-zfail.frame";
  const auto recorded = read(name);
  Inspection inspection(recorded, recorded->frame);
  for (const std::size_t commands : {30u, 43u, 20u, 21u, 5u, 0u, 28u, 1000u, 27u}) {
    inspection.seek(commands);
    EXPECT_EQ(stencil_of(inspection), stencil_after(name, commands)) << commands;
  }
}

TEST(Inspection, AskingLeavesThePositionAsItIs) {  // oracle: executing so far, anew
  const std::string name = "desk-01-zfail.frame";
  const auto recorded = read(name);
  Inspection inspection(recorded, recorded->frame);
  inspection.seek(25);
  inspection.history(7, 80, 60, 43);
  EXPECT_EQ(stencil_of(inspection), stencil_after(name, 25));
  inspection.fates(19, 27);
  EXPECT_EQ(stencil_of(inspection), stencil_after(name, 27));
}

// Oracle: in a frame that counts on depth fail by wrapping, what a stencil holds after the counts
// of one pass is what was raised less what was lowered.
TEST(Inspection, FatesOfAPassAddUpToItsCounts) {
  const auto recorded = read("desk-01-zfail.frame");
  Inspection inspection(recorded, recorded->frame);
  // Commands 20 to 26 of docs: volumes of real objects, after a clear.
  const raster::DrawFates fates = inspection.fates(19, 26);
  const std::vector<std::uint8_t> stencil = stencil_of(inspection);
  ASSERT_EQ(stencil.size(), fates.raised.size());
  std::size_t counted = 0;
  for (std::size_t i = 0; i < stencil.size(); ++i) {
    EXPECT_EQ(stencil[i], static_cast<std::uint8_t>(fates.raised[i] - fates.lowered[i]) & 0x7f);
    counted += stencil[i] != 0;
  }
  EXPECT_GT(counted, 1000u);
}

TEST(Inspection, GoldenFramesHaveHistoriesThatEndAtTheirBytes) {  // oracle: execute()
  for (const auto& entry : fs::directory_iterator(kFrames)) {
    const std::string name = entry.path().filename();
    if (name.find("1280") != std::string::npos) continue;
    const auto recorded = read(name), told_of = read(name);
    raster::execute(recorded->frame);
    const raster::Targets& targets = recorded->frame.passes().back().targets;
    std::mt19937 engine(7);
    for (int i = 0; i < 4; ++i) {
      const int x = static_cast<int>(engine() % static_cast<unsigned>(targets.width()));
      const int y = static_cast<int>(engine() % static_cast<unsigned>(targets.height()));
      const raster::PixelHistory told = raster::history(told_of->frame, x, y);
      const std::size_t last = told_of->frame.passes().size() - 1;
      for (auto record = told.commands.rbegin(); record != told.commands.rend(); ++record) {
        if (record->pass != last) continue;
        if (targets.stencil) {
          EXPECT_EQ(record->after.stencil, targets.stencil->at(x, y)) << name << x << " " << y;
        }
        if (targets.depth) {
          EXPECT_EQ(record->after.depth, targets.depth->at(x, y)) << name << x << " " << y;
        }
        break;
      }
    }
  }
}

TEST(Wireframe, OfAVolumeTellsSilhouetteSidesAndCapsApart) {  // oracle: the box's own edges
  LabState state = starting_state(LabStage::camera_in_shadow);
  state.method = LabMethod::zfail;
  state.camera_tilt_deg = 40.0;
  const auto lab = record_lab(state);
  for (const raster::Pass& pass : lab->frame.passes())
    for (const raster::Command& command : pass.commands) {
      const auto* draw = std::get_if<raster::Draw>(&command);
      if (!draw || draw->label.find("volume of box") != 0) continue;
      std::map<EdgeKind, int> edges;
      for (const WireEdge& edge : wireframe(*draw, pass.targets)) ++edges[edge.kind];
      // The lamp is above the box: it faces the lid and two or three sides at most.
      EXPECT_GE(edges[EdgeKind::front_cap], 5);
      EXPECT_GT(edges[EdgeKind::side], 0);
      EXPECT_EQ(edges[EdgeKind::mesh], 0);
      ASSERT_EQ(draw->parts.size(), 3u);
      EXPECT_EQ(draw->parts[1].label, "sides");
      return;
    }
  FAIL() << "no volume of the box";
}

TEST(Wireframe, AnEdgeOfTwoTrianglesIsThereOnce) {  // oracle: closed form
  raster::StencilBuffer stencil(8, 8);
  const std::vector<glm::vec4> positions{
      {-1, -1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}, {-1, 1, 0, 1}};
  const std::vector<std::uint32_t> indices{0, 1, 2, 0, 2, 3};
  raster::Draw draw;
  draw.mesh = {.positions = positions, .indices = indices};
  EXPECT_EQ(wireframe(draw, {.stencil = &stencil}).size(), 5u);
  draw.parts = {{"sides", 0}};
  const auto edges = wireframe(draw, {.stencil = &stencil});
  // A quad's silhouette edge is the first one of its first triangle: (0, 0) to (8, 0).
  EXPECT_EQ(edges.size(), 6u);
  EXPECT_EQ(edges.back().kind, EdgeKind::silhouette);
  EXPECT_EQ(edges.back().x1, 8 * 256);
  EXPECT_EQ(edges.back().y1, 0);
}

TEST(LabState, ComesBackFromItsText) {  // oracle: the state
  for (int stage = 0; stage < 5; ++stage) {
    LabState state = starting_state(static_cast<LabStage>(stage));
    EXPECT_EQ(read_lab_state(to_json(state)), state);
    state.light_x_m = 0.1;
    state.method = LabMethod::automatic;
    state.plates = 7;
    EXPECT_EQ(read_lab_state(to_json(state)), state);
  }
}

std::string error_of(const std::string& text) {
  try {
    read_lab_state(text);
  } catch (const LabError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LabState, ARefusalNamesTheFieldAndTheValue) {  // oracle: the documented contract
  const auto with = [](const std::string& fields) {
    return error_of(R"({"format": "gnomon-lab", "version": 1)" + fields + "}");
  };
  EXPECT_EQ(with(""), "no error");
  EXPECT_EQ(error_of("["), "this is no JSON object");
  EXPECT_EQ(error_of(R"({"version": 1})"), "'format' is not \"gnomon-lab\"");
  EXPECT_EQ(error_of(R"({"format": "gnomon-lab", "version": 2})"),
            "'version' is 2; version 1 can be read");
  EXPECT_EQ(with(R"(, "width": 15)"), "'width' is 15, not a whole number from 16 to 1920");
  EXPECT_EQ(with(R"(, "width": 64.5)"), "'width' is 64.5, not a whole number from 16 to 1920");
  EXPECT_EQ(with(R"(, "light_x_m": "far")"),
            "'light_x_m' is \"far\", not a number from -20.0 to 20.0");
  EXPECT_EQ(with(R"(, "light_x_m": 1e300)"),
            "'light_x_m' is 1e+300, not a number from -20.0 to 20.0");
  EXPECT_EQ(with(R"(, "method": "rays")"),
            "'method' is \"rays\", not one of zpass, zfail, auto, map");
  EXPECT_EQ(with(R"(, "saturate": 1)"), "'saturate' is 1, not true or false");
  EXPECT_EQ(with(R"(, "colour": 1)"), "there is no field 'colour'");
  EXPECT_EQ(with(R"(, "plates": [[1]])"), "'plates' is a list, not a whole number from 1 to 600");
  EXPECT_EQ(error_of(std::string(60'000, '[')), "this is no state: it is nested too deeply");
  EXPECT_EQ(error_of(R"({"format": "gnomon-lab"})"), "'version' is missing; version 1 can be read");
}

TEST(Turn, IsTheLibrarysToTheLastDigits) {  // oracle: std::cos and std::sin
  for (double degrees = -720.0; degrees <= 720.0; degrees += 0.37) {
    const Turn turn = turn_of_degrees(degrees);
    const double radians = degrees * (std::acos(-1.0) / 180.0);
    EXPECT_NEAR(turn.cosine, std::cos(radians), 3e-15) << degrees;
    EXPECT_NEAR(turn.sine, std::sin(radians), 3e-15) << degrees;
  }
  EXPECT_EQ(turn_of_degrees(90.0).sine, 1.0);
  EXPECT_EQ(turn_of_degrees(-180.0).cosine, -1.0);
}

/// Pixels whose colour differs.
std::size_t differing(const LabState& a, const LabState& b) {
  const auto picture = [](const LabState& state) {
    const auto lab = record_lab(state);
    raster::execute(lab->frame);
    return lab->color.to_rgba8_rows();
  };
  const std::vector<std::uint8_t> left = picture(a), right = picture(b);
  std::size_t count = 0;
  for (std::size_t i = 0; i < left.size(); i += 4)
    count += !std::equal(left.begin() + static_cast<std::ptrdiff_t>(i),
                         left.begin() + static_cast<std::ptrdiff_t>(i + 4),
                         right.begin() + static_cast<std::ptrdiff_t>(i));
  return count;
}

// Oracle of the lessons' states: z-fail with both caps and wrapping counts, which is right
// (docs/volumes.md), and the numbers of docs/lesson.md.
TEST(Lesson, ZPassIsRightOutsideTheShadowAndWrongInsideIt) {
  LabState state = starting_state(LabStage::camera_in_shadow), right = state;
  right.method = LabMethod::zfail;
  EXPECT_EQ(differing(state, right), 0u);
  for (LabState* s : {&state, &right}) {
    s->camera_turn_deg = -140.0;
    s->camera_tilt_deg = 10.0;
    s->camera_distance_m = 2.0;
  }
  EXPECT_EQ(differing(state, right), 173130u);
}

TEST(Lesson, AMissingBaseLeavesAShadowWhereThereIsNone) {
  LabState state = starting_state(LabStage::missing_cap), right = state;
  right.back_cap = true;
  EXPECT_EQ(differing(state, right), 2084u);
  // z-fail counts from infinity, so it is the front cap that it misses.
  state.method = right.method = LabMethod::zfail;
  EXPECT_EQ(differing(state, right), 0u);
  state.back_cap = true;
  state.front_cap = false;
  EXPECT_EQ(differing(state, right), 3262u);
}

TEST(Lesson, WrappingLoses256VolumesAndSaturatingWhatIsBeyond255) {
  LabState wraps = starting_state(LabStage::overflow), saturates = wraps;
  saturates.saturate = true;
  wraps.plates = saturates.plates = 255;
  EXPECT_EQ(differing(wraps, saturates), 0u);
  wraps.plates = saturates.plates = 256;
  EXPECT_EQ(differing(wraps, saturates), 5252u);
  wraps.plates = saturates.plates = 300;
  EXPECT_EQ(differing(wraps, saturates), 3624u);
}

TEST(Lesson, TheClassicalOutlineOfAnOpenBoxLosesPartOfItsShadow) {
  const LabState state = starting_state(LabStage::open_mesh);
  LabState right = state;
  right.classical_outline = false;
  EXPECT_EQ(differing(state, right), 3688u);
}

TEST(Lesson, AnOffsetStopsAcne) {
  LabState state = starting_state(LabStage::acne), right = state;
  right.method = LabMethod::zfail;
  EXPECT_EQ(differing(state, right), 49117u);
  state.map_offset_factor = 1.0;
  EXPECT_EQ(differing(state, right), 223u);
  state.map_offset_factor = 8.0;
  state.map_offset_units = 1000.0;
  EXPECT_EQ(differing(state, right), 1833u);
}

TEST(LiveView, KeysChooseBufferAndPass) {  // oracle: the documented keys
  apps::LiveView view;
  const ar::Image composite{1, 1, 3, {1, 2, 3}};
  const auto picture = [](std::uint8_t value) { return ar::Image{1, 1, 1, {value}}; };
  const std::vector<ar::PassPictures> steps{{"one", picture(1), picture(2), picture(3)},
                                            {"two", picture(4), picture(5), picture(6)}};
  EXPECT_FALSE(view.wants_steps());
  EXPECT_EQ(view.picture(composite, steps).pixels, composite.pixels);
  view.press('s');
  EXPECT_TRUE(view.wants_steps());
  EXPECT_THAT(view.picture(composite, steps).pixels, ElementsAre(6));
  EXPECT_EQ(view.caption(steps), "stencil after pass 2 of 2: two");
  for (int i = 0; i < 5; ++i) {
    view.press('p');
    view.see(steps.size());
  }
  view.press('d');
  EXPECT_THAT(view.picture(composite, steps).pixels, ElementsAre(2));
  view.press('n');
  view.see(steps.size());
  EXPECT_THAT(view.picture(composite, steps).pixels, ElementsAre(5));
  EXPECT_EQ(view.picture(composite, {}).pixels, composite.pixels);
  view.press(' ');
  EXPECT_TRUE(view.paused());
  view.press('q');
  EXPECT_TRUE(view.ended());
}

TEST_F(History, TellsEveryFragmentInWordsAndAsJson) {  // oracle: history() of the same frame
  const std::string frame = kFrames / "desk-01-zpass.frame";
  const Outcome text = run({"history", frame, "80", "60", "--around", "3"});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("step 2: volumes of virtual objects into the stencil buffer"));
  EXPECT_THAT(text.out, HasSubstr("stencil, x 77 to 83, y 57 to 63 from the bottom row"));
  const Outcome told = run({"history", frame, "80", "60", "--json"});
  ASSERT_EQ(told.status, 0) << told.err;
  const auto recorded = read("desk-01-zpass.frame");
  EXPECT_EQ(
      json::parse(told.out),
      json::parse(history_json(recorded->frame, raster::history(recorded->frame, 80, 60)).dump()));
}

TEST_F(History, RefusesWhatIsNotThere) {  // oracle: the documented contract
  const std::string frame = kFrames / "shadow-map-linear.frame";
  expect_one_line_error(run({"history", frame, "4000", "0"}),
                        "pixel 4000 0: the buffers of pass 3");
  expect_one_line_error(run({"history", frame, "0", "0", "--pass", "9"}), "the frame has 3 passes");
  EXPECT_EQ(run({"history", frame, "0", "-1"}).status, 1);
  expect_one_line_error(run({"history", frame, "0", "0", "--pass", "1", "--around", "2"}),
                        "pass 1 has no stencil buffer");
  expect_one_line_error(run({"history", frame, "0", "0", "--json", "--around", "2"}),
                        "not with --json");
}

TEST_F(Inspect, WritesOnePageWithoutALinkToAnywhere) {  // oracle: the documented contract
#ifndef GNOMON_HAS_PAGES
  GTEST_SKIP() << "this build has no pages";
#endif
  const std::string frame = kFrames / "boxes-zfail.frame";
  const Outcome made = run(
      {"inspect", frame, "--compare", kFrames / "boxes-zpass.frame", "--out", file("page.html")});
  ASSERT_EQ(made.status, 0) << made.err;
  const std::string page = text_of(file("page.html"));
  EXPECT_THAT(page, HasSubstr("gnomon-inspection"));
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_EQ(page.find("href=\"http"), std::string::npos);
  EXPECT_LT(page.size(), 15'000'000u);
}

TEST_F(Inspect, RefusesWhatItCannotShow) {  // oracle: the documented contract
  const std::string frame = kFrames / "boxes-zfail.frame", out = file("page.html");
  expect_one_line_error(run({"inspect", frame, "--image", "x.png", "--out", out}),
                        "--image goes with a scene file");
  expect_one_line_error(run({"inspect", frame, "--compare", "magic", "--out", out}),
                        "'magic' is no method");
  expect_one_line_error(run({"inspect", frame, "--compare", "zpass", "--out", out}),
                        "a frame has its method already");
  expect_one_line_error(run({"inspect", frame, "--samples", "2", "--out", out}), "go with --image");
  fs::copy_file(frame, file("own.frame"));
  EXPECT_EQ(run({"inspect", file("own.frame"), "--out", file("own.frame")}).status, 1);
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(Lab, DrawsAStateThatWasSaved) {  // oracle: replay of the frame that it saves
  std::ofstream(file("state.json"))
      << R"({"format": "gnomon-lab", "version": 1, "stage": "acne", "width": 64, "height": 48})";
  const Outcome drawn =
      run({"lab", file("state.json"), "--out", file("out"), "--save-frame", file("lab.frame")});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(fs::exists(file("out") + "/00_color.png"));
  const json replayed = json::parse(run({"replay", file("lab.frame"), "--json"}).out);
  for (const json& buffer : replayed["buffers"])
    EXPECT_THAT(drawn.out, HasSubstr(buffer["hash"].get<std::string>()));
  std::ofstream(file("state.json")) << R"({"format": "gnomon-lab", "version": 1, "plates": 0})";
  expect_one_line_error(run({"lab", file("state.json")}), "'plates' is 0");
  expect_one_line_error(run({"lab"}), "either a state or --page");
  expect_one_line_error(run({"lab", "--page", file("p.html"), "--out", file("out")}),
                        "go with a state");
}

}  // namespace
}  // namespace gnomon
