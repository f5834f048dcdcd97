// gnomon mesh as a person runs it, on good input and bad. Oracles: the documented contract, meshes
// whose topology is known, and mesh check on what the other commands write.
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kGltf = GNOMON_SOURCE_DIR "/tests/data/gltf/good/";
const std::string kMesh = GNOMON_SOURCE_DIR "/tests/data/mesh/good/";
const std::string kBad = GNOMON_SOURCE_DIR "/tests/data/mesh/bad/";

class MeshCommand : public Program {
 protected:
  json check(const std::string& path, int status) const {
    const Outcome got = run({"mesh", "check", path, "--json"});
    EXPECT_EQ(got.status, status) << got.err;
    EXPECT_EQ(std::count(got.out.begin(), got.out.end(), '\n'), 1);
    return json::parse(got.out);
  }
};

TEST_F(MeshCommand, CheckOfAClosedMeshEndsWithZero) {
  const Outcome text = run({"mesh", "check", kGltf + "Box.glb"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("12 triangles, 24 vertices (8 when welded), 18 edges, 1 pieces"));
  EXPECT_THAT(text.out, HasSubstr("casts a classical shadow volume"));
  EXPECT_THAT(text.out, Not(HasSubstr("FAULT")));
  const json line = check(kGltf + "Box.glb", 0);
  EXPECT_EQ(line["format"], "gnomon-mesh-check");
  EXPECT_EQ(line["version"], 1);
  EXPECT_EQ(line["verdict"], "closed");
  EXPECT_EQ(line["classical_volume"], true);
  EXPECT_EQ(line["euler_characteristic"], 2);
  EXPECT_EQ(line["repeated_vertices"], 16);
}

TEST_F(MeshCommand, CheckOfAFaultyMeshReportsAndEndsWithOne) {
  const Outcome text = run({"mesh", "check", kMesh + "boxNotManifold.obj"});
  EXPECT_EQ(text.status, 1);
  EXPECT_THAT(text.out, HasSubstr("FAULT 4 edges with one triangle only\n"));
  EXPECT_THAT(text.out, HasSubstr("triangles "));
  EXPECT_THAT(text.out, HasSubstr("open: casts no classical shadow volume"));
  EXPECT_EQ(text.err,
            "gnomon: " + kMesh + "boxNotManifold.obj: open: 4 edges with one triangle only\n");
  const json line = check(kMesh + "joined_tetrahedra.obj", 1);
  EXPECT_EQ(line["verdict"], "non-manifold");
  EXPECT_EQ(line["non_manifold_edges"]["count"], 3);
  EXPECT_EQ(line["non_manifold_edges"]["places"].size(), 3u);
  EXPECT_EQ(line["non_manifold_edges"]["places"][0]["triangles"].size(), 4u);
  EXPECT_EQ(line["non_manifold_edges"]["places"][0]["positions_m"].size(), 2u);
  EXPECT_EQ(line["duplicate_triangles"]["count"], 1);
  EXPECT_EQ(line["open_edges"]["count"], 0);
}

TEST_F(MeshCommand, CheckTakesPlacesToleranceAndNoIntersections) {
  const Outcome got = run({"mesh", "check", kMesh + "soup.stl", "--json", "--places", "2",
                           "--tolerance", "0.125", "--no-self-intersections"});
  EXPECT_EQ(got.status, 1);
  const json line = json::parse(got.out);
  EXPECT_EQ(line["open_edges"]["count"], 300);
  EXPECT_EQ(line["open_edges"]["places"].size(), 2u);
  EXPECT_EQ(line["tolerance_m"], 0.125);
  EXPECT_TRUE(line["self_intersections"].is_null());
}

TEST_F(MeshCommand, AFileThatCannotBeReadIsOneLineAndNoReport) {
  const std::string glb = text_of(kGltf + "Box.glb");
  std::ofstream(file("cut.glb"), std::ios::binary) << glb.substr(0, 700);
  std::ofstream(file("text.stl")) << "no mesh\nat all\n";
  std::ofstream(file("mesh.xyz")) << "0 0 0\n";
  for (const std::string& path : {file("missing.obj"), file("cut.glb"), file("text.stl"),
                                  file("mesh.xyz"), kBad + "empty.obj", kBad + "empty.ply"}) {
    const std::string name = fs::path(path).filename().string();
    expect_one_line_error(run({"mesh", "check", path}), name);
    expect_one_line_error(run({"mesh", "repair", path, "-o", file("out.glb")}), name);
    EXPECT_FALSE(fs::exists(file("out.glb"))) << path;
  }
  expect_one_line_error(
      run({"mesh", "simplify", file("cut.glb"), "--error", "1m", "-o", file("out.glb")}),
      "cut.glb");
}

TEST_F(MeshCommand, RepairWritesAMeshThatPassesTheCheck) {
  const std::pair<std::string, std::string> kCases[] = {{"joined_tetrahedra.obj", "out.glb"},
                                                        {"not_convex.obj", "out.ply"},
                                                        {"cube_no_bottom.obj", "out.gltf"},
                                                        {"soup.stl", "out.stl"}};
  for (const auto& [name, out] : kCases) {
    const Outcome got = run({"mesh", "repair", kMesh + name, "-o", file(out)});
    ASSERT_EQ(got.status, 0) << got.err;
    EXPECT_THAT(got.out, StartsWith("before: "));
    EXPECT_THAT(got.out, HasSubstr("no vertex moved by more than"));
    EXPECT_THAT(got.out, HasSubstr(" triangles, closed\n"));
    check(file(out), 0);
  }
}

TEST_F(MeshCommand, RepairSaysWhatItDidAndWhatIsLeft) {
  const Outcome got =
      run({"mesh", "repair", kMesh + "cube_no_bottom.obj", "-o", file("out.glb"), "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  EXPECT_EQ(line["format"], "gnomon-mesh-repair");
  EXPECT_EQ(line["version"], 1);
  EXPECT_EQ(line["done"]["closed_holes"], 1);
  EXPECT_EQ(line["done"]["hole_triangles"], 6);
  EXPECT_EQ(line["largest_move_m"], 0.0);
  EXPECT_EQ(line["before"]["verdict"], "open");
  EXPECT_EQ(line["after"]["verdict"], "closed");
  const Outcome open = run(
      {"mesh", "repair", kMesh + "cube_no_bottom.obj", "-o", file("open.glb"), "--max-hole", "7"});
  EXPECT_EQ(open.status, 0) << open.err;
  EXPECT_THAT(open.out, HasSubstr("1 holes or outlines are left, the longest of 8 edges"));
  check(file("open.glb"), 1);
}

TEST_F(MeshCommand, SimplifyStaysWithinPixelsAndClosed) {
  const std::string torus = GNOMON_SOURCE_DIR "/examples/desk/virtual/torus.glb";
  const Outcome got = run({"mesh", "simplify", torus, "--error", "0.5px", "--distance", "0.4", "-o",
                           file("out.glb"), "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  EXPECT_EQ(line["format"], "gnomon-mesh-simplify");
  // 2 * 0.4 m * tan(25 degrees) / 1080 rows, halved.
  EXPECT_NEAR(line["error_m"].get<double>(), 0.5 * 0.8 * 0.46630766 / 1080.0, 1e-9);
  EXPECT_LE(line["measured_error_m"], line["error_m"]);
  EXPECT_LT(line["triangles_after"], line["triangles_before"]);
  EXPECT_EQ(check(file("out.glb"), 0)["triangles"], line["triangles_after"]);
  const Outcome metres = run({"mesh", "simplify", torus, "--error", "0.002m", "-o", file("m.glb")});
  ASSERT_EQ(metres.status, 0) << metres.err;
  EXPECT_THAT(metres.out, HasSubstr("within 0.002 m"));
}

TEST_F(MeshCommand, MisuseIsOneLineAndWritesNothing) {
  const std::string box = kGltf + "Box.glb", out = file("out.glb");
  const auto simplify = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"mesh", "simplify", box, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  expect_one_line_error(simplify({"--error", "0.5px"}), "--distance");
  for (const char* error : {"0.5", "px", "-1px", "0m", "nanm", "1cm", "1e999m"})
    expect_one_line_error(simplify({"--error", error, "--distance", "1"}), error);
  expect_one_line_error(run({"mesh", "repair", box, "-o", file("out.fbx")}), "'.fbx' is no format");
  expect_one_line_error(run({"mesh", "repair", box, "-o", file("no/out.glb")}), "out.glb");
  EXPECT_EQ(run({"mesh"}).status, 1);
  EXPECT_EQ(run({"mesh", "repair", box}).status, 1);
  EXPECT_EQ(run({"mesh", "repair", box, "-o", out, "--max-hole", "100000"}).status, 1);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(out).parent_path()))
    files += !entry.path().filename().string().starts_with("std");
  EXPECT_EQ(files, 0u);
}

TEST_F(MeshCommand, TheInputIsNotReplaced) {
  fs::copy_file(kGltf + "Box.glb", file("box.glb"));
  const std::string before = text_of(file("box.glb"));
  expect_one_line_error(run({"mesh", "repair", file("box.glb"), "-o", file("box.glb")}), "box.glb");
  EXPECT_EQ(text_of(file("box.glb")), before);
}

TEST_F(MeshCommand, HelpHasExamples) {
  for (const char* command : {"check", "repair", "simplify"}) {
    const Outcome help = run({"mesh", command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Examples:"));
    EXPECT_THAT(help.out, HasSubstr(std::string("gnomon mesh ") + command));
  }
}

}  // namespace
}  // namespace gnomon
