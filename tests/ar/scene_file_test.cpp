#include "ar/scene_file.h"
#include "ar/scene_nodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "ar/capture_file.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/scene_models.h"
#include "pipeline/surface_distance.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kRoot = GNOMON_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder with the files that the scenes below name.
class SceneFolder {
 public:
  SceneFolder() {
    for (const char* name : {"camera.yml", "my_tags.yml", "response.json", "tags.yaml"})
      write_file(folder_.path() / name, "a file");
    for (const char* name : {"table.glb", "house.glb", "torus.glb"})
      fs::copy(kRoot / "examples/desk/virtual/torus_lo.glb", folder_.path() / name);
    fs::copy(kRoot / "examples/desk/scene.glb", folder_.path() / "room.glb");
  }
  fs::path write(const std::string& toml) const {
    write_file(folder_.path() / "scene.toml", toml);
    return folder_.path() / "scene.toml";
  }
  SceneFile read(const std::string& toml) const { return read_scene(write(toml)); }
  std::string message(const std::string& toml) const {
    try {
      require_photograph(read(toml));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  const fs::path& path() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

/// Line 1 to 17; what a test adds begins in line 18.
const std::string kSmall = R"(format = "gnomon-scene 1"
[camera]
file = "camera.yml"
[[tag]]
family = "tag36h11"
id = 3
size_m = 0.1
[[object]]
name = "torus"
role = "virtual"
model = "torus.glb"
[[light]]
name = "lamp"
position_m = [1, 2, 3]
[[body]]
name = "box"
tag = [{ family = "tag36h11", id = 4, size_m = 0.05 }]
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// Oracle: the example as a person reads it.
TEST(SceneFile, TheExampleOfTheDocumentationIsReadAsItSays) {
  const SceneFolder folder;
  const std::string doc = text_of(kRoot / "docs/scene.md");
  const std::size_t begin = doc.find("```toml\n") + 8;
  const SceneFile scene = folder.read(doc.substr(begin, doc.find("```", begin) - begin));
  EXPECT_EQ(scene.camera_file, folder.path() / "camera.yml");
  EXPECT_EQ(scene.near_m, 0.1);
  EXPECT_EQ(scene.ambient, glm::vec3(0.4f, 0.32f, 0.24f));
  EXPECT_THAT(scene.families, ElementsAre("tag36h11", "my_tags"));
  EXPECT_EQ(scene.gamma, 2.2);
  ASSERT_EQ(scene.dictionaries.size(), 1u);
  EXPECT_EQ(scene.dictionaries[0].file, folder.path() / "my_tags.yml");

  ASSERT_EQ(scene.tags.world.tags.size(), 2u);
  const PlacedTag& tag = scene.tags.world.tags[0];
  EXPECT_EQ(tag.id, (TagId{"tag36h11", 0}));
  EXPECT_EQ(tag.size_m, 0.08);
  EXPECT_EQ(tag.body_from_tag * glm::dvec4(0, 0, 1, 1), glm::dvec4(-0.2, 1.0, 0.1, 1.0))
      << "z out of the face is the world's y";
  ASSERT_EQ(scene.tags.bodies.size(), 1u);
  EXPECT_EQ(scene.tags.bodies[0].name, "house");
  EXPECT_EQ(scene.tags.bodies[0].tags[0].body_from_tag, glm::dmat4(1.0));

  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[0].role, pipeline::Role::phantom);
  EXPECT_FALSE(scene.objects[0].casts);
  EXPECT_TRUE(scene.objects[0].receives);
  EXPECT_EQ(scene.objects[1].attached_to, "house");
  EXPECT_EQ(scene.objects[2].role, pipeline::Role::virtual_object);
  EXPECT_EQ(scene.objects[2].model, folder.path() / "torus.glb");

  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].position, glm::vec4(1.3f, 1.9f, -1.3f, 1.0f));
  EXPECT_EQ(scene.lights[0].radius, 0.01f);
  // The estimate of the bulb in the desk's model is about 1 cm from its place (1.35, 1.95, -1.35).
  EXPECT_LT(glm::distance(glm::vec3(scene.lights[1].position), glm::vec3(1.35f, 1.95f, -1.35f)),
            0.02f);
  EXPECT_EQ(scene.lights[1].samples, 8);
  EXPECT_EQ(scene.lights[2].position.w, 0.0f);
  EXPECT_NEAR(glm::length(scene.lights[2].position), 1.0f, 1e-6f);
  EXPECT_EQ(scene.shadow.method, ShadowMethod::automatic);
  EXPECT_EQ(scene.shadow.volume, VolumeReach(AutomaticReach{}));
  EXPECT_TRUE(scene.filter.on);
}

// Oracle: turning x by 90 degrees about z gives y; the order is x, then y, then z.
TEST(SceneFile, RotationsTurnAboutXThenYThenZ) {
  const SceneFolder folder;
  const auto pose = [&](const std::string& keys) {
    return folder
        .read(replaced(kSmall, "model = \"torus.glb\"\n", "model = \"torus.glb\"\n" + keys))
        .objects[0]
        .body_from_object;
  };
  const auto expect_maps = [](const glm::dmat4& m, glm::dvec3 from, glm::dvec3 to) {
    EXPECT_LT(glm::distance(glm::dvec3(m * glm::dvec4(from, 1.0)), to), 1e-12);
  };
  expect_maps(pose("rotation_deg = [0, 0, 90]\n"), {1, 0, 0}, {0, 1, 0});
  // y to z (about x), then z to x (about y), then x to y (about z).
  expect_maps(pose("rotation_deg = [90, 90, 90]\n"), {0, 1, 0}, {0, 1, 0});
  expect_maps(pose("rotation_deg = [90, 0, 90]\n"), {0, 1, 0}, {0, 0, 1});
  expect_maps(pose("quaternion = [0, 0, 0.7071067811865476, 0.7071067811865476]\n"), {1, 0, 0},
              {0, 1, 0});
  expect_maps(pose("position_m = [1, 2, 3]\nscale = 2\n"), {1, 0, 0}, {3, 2, 3});
}

// Oracle: OpenGL's camera looks along -z with y up, OpenCV's along z with y down.
TEST(SceneFile, CameraAxesAreTurnedToOpenCvs) {
  const SceneFolder folder;
  const std::string identity = "world_from_camera = [[1,0,0,5],[0,1,0,6],[0,0,1,7],[0,0,0,1]]\n";
  const auto read = [&](const std::string& keys) {
    return *folder.read(replaced(kSmall, "[[tag]]", keys + "[[tag]]")).world_from_camera;
  };
  EXPECT_EQ(read(identity)[2], glm::dvec4(0, 0, 1, 0));
  const glm::dmat4 m = read("axes = \"opengl\"\n" + identity);
  EXPECT_EQ(m[0], glm::dvec4(1, 0, 0, 0));
  EXPECT_EQ(m[1], glm::dvec4(0, -1, 0, 0));
  EXPECT_EQ(m[2], glm::dvec4(0, 0, -1, 0));
  EXPECT_EQ(m[3], glm::dvec4(5, 6, 7, 1));
}

TEST(SceneFile, DefaultsAndSettings) {
  const SceneFolder folder;
  SceneFile scene = folder.read(kSmall);
  EXPECT_THAT(scene.families, ElementsAre("tag36h11"));
  EXPECT_FALSE(scene.world_from_camera);
  EXPECT_EQ(scene.lights[0].share, 0.5f);
  EXPECT_EQ(scene.lights[0].samples, 1);
  scene = folder.read(kSmall +
                      "[shadow]\nmethod = \"zfail\"\nvolume = \"infinite\"\ndouble_shadows = true\n"
                      "[filter]\non = false\nbeta_per_m = 3\n"
                      "[tags_yaml]\nfile = \"tags.yaml\"\nworld = \"room\"\n");
  EXPECT_EQ(scene.shadow.method, ShadowMethod::zfail);
  EXPECT_EQ(scene.shadow.volume, VolumeReach(InfiniteReach{}));
  EXPECT_TRUE(scene.shadow.double_shadows);
  EXPECT_FALSE(scene.filter.on);
  EXPECT_EQ(scene.filter.beta_per_m, 3.0);
  ASSERT_TRUE(scene.tags_yaml);
  EXPECT_EQ(scene.tags_yaml->world, "room");
  EXPECT_EQ(folder.read(kSmall + "[shadow]\nvolume = 2.5\n").shadow.volume, VolumeReach(2.5));
}

TEST(SceneFile, LightingIsPixelByPixelUnlessItIsAskedForAtVertices) {
  const SceneFolder folder;
  const auto lit_at_vertices = [&](const std::string& key) {
    const SceneFile scene = folder.read(key + kSmall);
    return SceneNodes(scene, load_models(scene)).scene().vertex_lighting;
  };
  EXPECT_FALSE(lit_at_vertices(""));
  EXPECT_FALSE(lit_at_vertices("lighting = \"pixel\"\n"));
  EXPECT_TRUE(lit_at_vertices("lighting = \"vertex\"\n"));
  EXPECT_THAT(folder.message("lighting = \"phong\"\n" + kSmall),
              HasSubstr("scene.toml:1: lighting: 'phong' is not one of pixel, vertex"));
}

struct Wrong {
  const char *from, *to, *message;
};

// Oracle: the line, the table, the key and the value of each change.
TEST(SceneFile, MistakesAreNamedByLineTableKeyAndValue) {
  const SceneFolder folder;
  const Wrong cases[] = {
      {"role = \"virtual\"", "rolle = \"virtual\"",
       "scene.toml:10: [object 'torus'].rolle: unknown key (known: name, role, model, "},
      {"role = \"virtual\"\n", "", "scene.toml:8: [object 'torus'].role: missing"},
      {"role = \"virtual\"", "role = \"ghost\"",
       "scene.toml:10: [object 'torus'].role: 'ghost' is not one of virtual, phantom"},
      {"role = \"virtual\"", "role = 5", "[object 'torus'].role: 5 is not a text in quotes"},
      {"model = \"torus.glb\"", "model = \"no.glb\"",
       "scene.toml:11: [object 'torus'].model: no such file: "},
      {"model = \"torus.glb\"", "model = \"a\\u0000b\"", "has a control character"},
      {"id = 3", "id = \"three\"", "scene.toml:6: [tag].id: 'three' is not an integer"},
      {"id = 3", "id = 3.5", "[tag].id: 3.5 is not an integer"},
      {"id = 3", "id = -3", "[tag].id: -3 is not within 0 to 1000000"},
      {"id = 3", "id = 4", "scene.toml:17: [body 'box' tag].id: tag 4 of tag36h11 is used twice"},
      {"family = \"tag36h11\"", "family = \"tag99h99\"",
       "scene.toml:5: [tag].family: 'tag99h99' is neither a tag family that is known nor a"},
      {"size_m = 0.1", "size_m = nan", "scene.toml:7: [tag].size_m: nan is not finite"},
      {"size_m = 0.1", "size_m = inf", "[tag].size_m: inf is not finite"},
      {"size_m = 0.1", "size_m = 0", "[tag].size_m: 0 is not within 0.0001 to 1000"},
      {"size_m = 0.1", "size_m = 0.1\nworld_from_tag = [[1,0,0,0],[0,nan,0,0],[0,0,1,0],[0,0,0,1]]",
       "scene.toml:8: [tag].world_from_tag[1][1]: nan is not finite"},
      {"size_m = 0.1", "size_m = 0.1\nworld_from_tag = [[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]",
       "[tag].world_from_tag: is not a rotation and translation (determinant 8)"},
      {"size_m = 0.1", "size_m = 0.1\nworld_from_tag = [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]",
       "[tag].world_from_tag: is not a rotation and translation (determinant -1)"},
      {"size_m = 0.1", "size_m = 0.1\nworld_from_tag = [[1,0,0,0],[0,1,0,0],[0,0,1,0]]",
       "is not a list of 4 rows"},
      {"size_m = 0.1", "size_m = 0.1\nworld_from_tag = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]",
       "last row [ 0, 0, 1, 1 ] is not [0, 0, 0, 1]"},
      {"size_m = 0.1", "size_m = 0.1\nquaternion = [0, 0, 0, 2]", "has length 2, not 1"},
      {"model = \"torus.glb\"", "model = \"torus.glb\"\nattached_to = \"bux\"",
       "scene.toml:12: [object 'torus'].attached_to: 'bux' is neither world nor a [[body]]"},
      {"model = \"torus.glb\"",
       "model = \"torus.glb\"\nworld_from_object = [[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]",
       "[object 'torus'].world_from_object: mirrors or flattens (determinant -1)"},
      {"model = \"torus.glb\"",
       "model = \"torus.glb\"\nscale = 2\nworld_from_object = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,"
       "0,1]]",
       "[object 'torus'].scale: together with world_from_object: give one of them"},
      {"model = \"torus.glb\"", "model = \"torus.glb\"\ncasts = 1",
       "[object 'torus'].casts: 1 is not true or false"},
      {"position_m = [1, 2, 3]", "position_m = [1, 2]",
       "scene.toml:14: [light 'lamp'].position_m: [ 1, 2 ] is not a list of 3 numbers"},
      {"position_m = [1, 2, 3]", "share = 0.5",
       "[light 'lamp'].position_m: give one of position_m, direction_towards, node"},
      {"position_m = [1, 2, 3]", "direction_towards = [0, 0, 0]",
       "[light 'lamp'].direction_towards: has no length"},
      {"position_m = [1, 2, 3]", "position_m = [1, 2, 3]\nshare = 1.5",
       "scene.toml:15: [light 'lamp'].share: 1.5 is not within 0 to 1"},
      {"position_m = [1, 2, 3]", "node = \"sun\"\nmodel = \"room.glb\"",
       "[light 'lamp'].node: no node 'sun' in "},
      {"position_m = [1, 2, 3]", "position_m = [1, 2, 3]\nradius_deg = 1",
       "[light 'lamp'].radius_deg: a light in the room has radius_m"},
      {"\"gnomon-scene 1\"", "\"gnomon-scene 2\"",
       "scene.toml:1: format: 'gnomon-scene 2' is not read (accepted: \"gnomon-scene 1\")"},
      {"format = \"gnomon-scene 1\"\n", "", "format: missing (accepted: \"gnomon-scene 1\")"},
      {"[camera]\nfile = \"camera.yml\"\n", "", "camera: missing"},
      {"file = \"camera.yml\"", "file = \"camera.yml\"\nnear_m = 5\nfar_m = 1",
       "scene.toml:5: [camera].far_m: far_m 1 is not beyond near_m 5"},
      {"file = \"camera.yml\"", "file = \"camera.yml\"\nsamples = 9",
       "scene.toml:4: [camera].samples: 9 is not within 1 to 8"},
      {"file = \"camera.yml\"", "file = \"camera.yml\"\nsamples = 1.5",
       "scene.toml:4: [camera].samples: 1.5 is not an integer"},
      {"name = \"box\"", "name = \"world\"", "[body 'world'].name: 'world' is not a body"},
      {"[[light]]", "[light]", "light: a table is not a list of tables: write [[light]]"},
      {"id = 3", "id = ", "scene.toml:6: "},
      {"id = 3", "id = 3\nid = 4", "scene.toml:7: "}};
  for (const Wrong& wrong : cases) {
    const std::string message = folder.message(replaced(kSmall, wrong.from, wrong.to));
    EXPECT_THAT(message, HasSubstr(wrong.message)) << wrong.to;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(SceneFile, SaysHowManyPixelsAreDrawnForOne) {
  const SceneFolder folder;
  EXPECT_EQ(folder.read(kSmall).samples, 0);
  EXPECT_EQ(
      folder.read(replaced(kSmall, "file = \"camera.yml\"", "file = \"camera.yml\"\nsamples = 3"))
          .samples,
      3);
}

/// Two groups, a spot on one, and two casters.
const std::string kGraph = kSmall + R"([[group]]
name = "table"
position_m = [0, 1, 0]
[[group]]
name = "tray"
attached_to = "table"
rotation_deg = [0, 90, 0]
[[object]]
name = "cup"
role = "virtual"
model = "torus.glb"
attached_to = "tray"
position_m = [1, 0, 0]
[[light]]
name = "spot"
position_m = [0, 1, 0]
attached_to = "tray"
spot_deg = 60
spot_direction = [2, 0, 0]
spot_exponent = 3
[[caster]]
node = "table"
light = "spot"
method = "map"
size = 512
sides = 1
fov_deg = 90
near_m = 0.1
far_m = 5
displace_scale = 1.5
displace_offset = 4
filter = "linear"
depth_bits = 16
[[caster]]
light = "lamp"
)";

// Oracle: a quarter about y takes x to -z.
TEST(SceneFile, GroupsPlaceWhatHangsOnThem) {
  const SceneFolder folder;
  const SceneFile file = folder.read(kGraph);
  const pipeline::Scene scene = SceneNodes(file, load_models(file)).scene();
  ASSERT_EQ(scene.objects.size(), 2u);
  const auto find = [](const auto& items, const std::string& name) {
    return *std::ranges::find_if(items, [&](const auto& item) { return item.name == name; });
  };
  const glm::vec3 cup(find(scene.objects, "cup").world_from_model[3]);
  EXPECT_LT(glm::distance(cup, glm::vec3(0.0f, 1.0f, -1.0f)), 1e-6f);
  const pipeline::Light spot = find(scene.lights, "spot");
  EXPECT_EQ(spot.position, glm::vec4(0.0f, 2.0f, 0.0f, 1.0f));
  EXPECT_LT(glm::distance(spot.spot_direction, glm::vec3(0.0f, 0.0f, -1.0f)), 1e-6f);
  EXPECT_NEAR(spot.spot_cos_cutoff, 0.5f, 1e-6f);
  EXPECT_EQ(spot.spot_exponent, 3);
  EXPECT_EQ(find(scene.lights, "lamp").spot_cos_cutoff, -1.0f);
}

TEST(SceneFile, CastersSayWhoCastsWhichShadowAndHow) {
  const SceneFolder folder;
  const SceneFile file = folder.read(kGraph);
  const pipeline::Scene scene = SceneNodes(file, load_models(file)).scene();
  using enum pipeline::ShadowMethod;
  const bool cup_first = scene.objects[0].name == "cup";
  for (const pipeline::Light& light : scene.lights) {
    if (light.name == "lamp")
      EXPECT_THAT(light.shadow_of_object, ElementsAre(volumes, volumes));
    else
      EXPECT_THAT(light.shadow_of_object,
                  ElementsAre(cup_first ? map : none, cup_first ? none : map));
    if (light.name != "spot") continue;
    EXPECT_EQ(light.map.size, 512);
    EXPECT_EQ(light.map.sides, pipeline::MapSides::one);
    EXPECT_NEAR(light.map.fov_tangent.value(), 1.0f, 1e-6f);
    EXPECT_EQ(light.map.near_far_m, glm::vec2(0.1f, 5.0f));
    EXPECT_EQ(light.map.offset->factor, 1.5f);
    EXPECT_EQ(light.map.offset->units, 4.0f);
    EXPECT_EQ(light.map.filter, raster::Filter::linear);
    EXPECT_EQ(light.map.format, raster::DepthFormat::d16);
  }
}

// What hangs on a body is there when the body is.
TEST(SceneFile, BodiesAreThereWhenTheyArePlaced) {
  const SceneFolder folder;
  const SceneFile file = folder.read(
      replaced(kGraph, "name = \"table\"\n", "name = \"table\"\nattached_to = \"box\"\n"));
  SceneNodes nodes(file, load_models(file));
  EXPECT_THAT(nodes.bodies(), ElementsAre("box"));
  EXPECT_THAT(nodes.left_out(), ElementsAre("cup"));
  EXPECT_EQ(nodes.scene().lights.size(), 1u);
  glm::dmat4 pose(1.0);
  pose[3].x = 7.0;
  nodes.place("box", pose);
  EXPECT_TRUE(nodes.left_out().empty());
  EXPECT_EQ(nodes.scene().lights.size(), 2u);
  EXPECT_EQ(nodes.scene().lights[0].position.x + nodes.scene().lights[1].position.x, 8.0f);
}

// Oracle: OpenCV's axes of a camera that looks along -z from (0, 0, 5), y up in the world.
TEST(SceneFile, ACameraCanBeGivenByWhereItLooks) {
  const SceneFolder folder;
  const SceneFile scene =
      folder.read(replaced(kSmall, "file = \"camera.yml\"",
                           "fov_y_deg = 90\nwidth = 200\nheight = 100\neye_m = [0, 0, 5]\n"
                           "target_m = [0, 0, 1]"));
  ASSERT_TRUE(scene.pinhole && scene.world_from_camera);
  EXPECT_NEAR(scene.pinhole->fx, 50.0, 1e-9);
  EXPECT_EQ(scene.pinhole->cx, 99.5);
  const glm::dmat4 expected(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1);
  EXPECT_EQ(*scene.world_from_camera, expected);
}

TEST(SceneFile, SaysWhatIsWrongWithNodesAndCasters) {
  const SceneFolder folder;
  const std::vector<Wrong> cases{
      {"attached_to = \"table\"", "attached_to = \"tray\"",
       "[group 'tray'].attached_to: 'tray' is neither world nor a [[body]] nor a [[group]] above"},
      {"name = \"table\"", "name = \"box\"", "[group 'box'].name: 'box' is the world's or a"},
      {"spot_deg = 60", "spot_deg = 91", "[light 'spot'].spot_deg: 91 is not within 0.1 to 90"},
      {"spot_deg = 60\n", "", "[light 'spot'].spot_direction: without spot_deg"},
      {"spot_direction = [2, 0, 0]", "spot_direction = [0, 0, 0]", "spot_direction: has no length"},
      {"node = \"table\"", "node = \"chair\"",
       "[caster].node: 'chair' is no [[object]], [[group]] or [[body]]"},
      {"light = \"spot\"", "light = \"moon\"", "[caster].light: 'moon' is no [[light]]"},
      {"method = \"map\"", "method = \"ray\"", "[caster].method: 'ray' is not one of volumes, map"},
      {"method = \"map\"\n", "", "[caster].size: is a shadow map's: give method = \"map\""},
      {"sides = 1", "sides = 3", "[caster].sides: 3 is not 1 or 6"},
      {"sides = 1", "sides = 6", "[caster].fov_deg: is of one map, not of sides = 6"},
      {"name = \"tray\"", "name = \"cup\"", "[object 'cup'].attached_to: 'tray' is neither"},
      {"file = \"camera.yml\"", "file = \"camera.yml\"\nwidth = 640",
       "[camera].width: together with file"},
      {"far_m = 5\n", "", "[caster].far_m: missing"},
      {"far_m = 5\n", "far_m = 0.05\n", "[caster].far_m: 0.05 is not beyond near_m 0.1"},
      {"filter = \"linear\"", "filter = \"soft\"", "[caster].filter: 'soft' is not one of"},
      {"depth_bits = 16", "depth_bits = 20", "[caster].depth_bits: 20 is not 16 or 24"},
      {"file = \"camera.yml\"", "fov_y_deg = 40\neye_m = [0, 1, 0]\ntarget_m = [0, 0, 0]",
       "[camera].target_m: the eye looks along the direction that is up"},
      {"file = \"camera.yml\"", "eye_m = [0, 1, 0]",
       "[camera].file: missing: give file, or fov_y_deg with width, height"}};
  for (const Wrong& wrong : cases) {
    const std::string message = folder.message(replaced(kGraph, wrong.from, wrong.to));
    EXPECT_THAT(message, HasSubstr(wrong.message)) << wrong.to;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(SceneFile, NamesThatAreUsedTwiceAreRefused) {
  const SceneFolder folder;
  EXPECT_THAT(folder.message(kSmall + "[[object]]\nname = \"torus\"\nrole = \"phantom\"\n"
                                      "model = \"torus.glb\"\n"),
              HasSubstr("scene.toml:19: [object 'torus'].name: 'torus' is used twice"));
  EXPECT_THAT(folder.message(kSmall + "[[light]]\nname = \"lamp\"\nposition_m = [0, 0, 0]\n"),
              HasSubstr("[light 'lamp'].name: 'lamp' is used twice"));
}

TEST(SceneFile, WithoutTagsTheCameraMustBeGiven) {
  const SceneFolder folder;
  std::string bare = replaced(kSmall, "[[tag]]\nfamily = \"tag36h11\"\nid = 3\nsize_m = 0.1\n", "");
  bare = bare.substr(0, bare.find("[[body]]"));
  EXPECT_THAT(folder.message(bare), HasSubstr("without tags the camera needs"));
  EXPECT_EQ(folder.message(replaced(
                bare, "[[object]]",
                "world_from_camera = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\n[[object]]")),
            "");
}

TEST(SceneFile, MissingAndOverlongFilesAreRefused) {
  const SceneFolder folder;
  EXPECT_THROW(read_scene(folder.path() / "no.toml"), InputError);
  EXPECT_THROW(read_scene(folder.path()), InputError);
  EXPECT_THAT(folder.message(std::string(2 << 20, '#')), HasSubstr("more than the"));
  EXPECT_THAT(folder.message("a = " + std::string(50000, '[')), HasSubstr("scene.toml:1: "));
}

// Oracle: no crash; run under ASan and UBSan too.
TEST(SceneFile, EveryTruncationAndFlippedByteIsReadOrRefused) {
  const SceneFolder folder;
  for (std::size_t at = 0; at < kSmall.size(); ++at) {
    std::string bad = kSmall;
    bad[at] = static_cast<char>(bad[at] ^ 0x15);
    for (const std::string& text : {kSmall.substr(0, at), bad})
      EXPECT_EQ(folder.message(text).find('\n'), std::string::npos);
  }
}

// Oracle: every scene that the repository brings is accepted, and its models load.
TEST(SceneFile, TheExamplesOfTheRepositoryAreRead) {
  int count = 0;
  for (const char* folder : {"examples", "tests/data/desk"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      // The other formats in these folders have readers and tests of their own.
      const fs::path name = entry.path().filename();
      if (name.extension() != ".toml" || name == kCaptureName || name == "study.toml") continue;
      const SceneFile scene = read_scene(entry.path());
      EXPECT_EQ(load_models(scene).size(), scene.objects.size()) << entry.path();
      ++count;
    }
  EXPECT_GE(count, 13);
}

// Oracle: one file, one model.
TEST(SceneFile, ObjectsThatNameOneFileShareItsModel) {
  const SceneFolder folder;
  const SceneFile scene = folder.read(kSmall +
                                      "[[object]]\nname = \"second\"\nrole = \"phantom\"\n"
                                      "model = \"./torus.glb\"\n");
  const auto models = load_models(scene);
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(models[0].model, models[1].model);
  EXPECT_EQ(models[0].shadow_model, nullptr);
}

// Oracle: the file's text; the mesh reaches the scene that is drawn, where the body is placed.
TEST(SceneFile, AShadowModelCastsInTheModelsPlace) {
  const SceneFolder folder;
  fs::copy(kRoot / "examples/desk/virtual/torus.glb", folder.path() / "fine.glb");
  const std::string toml = replaced(kSmall, "model = \"torus.glb\"\n",
                                    "model = \"fine.glb\"\nshadow_model = \"torus.glb\"\n") +
                           "[[object]]\nname = \"second\"\nrole = \"phantom\"\n"
                           "model = \"torus.glb\"\nattached_to = \"box\"\n"
                           "shadow_model = \"./torus.glb\"\n";
  const SceneFile file = folder.read(toml);
  EXPECT_EQ(file.objects[0].shadow_model, folder.path() / "torus.glb");
  EXPECT_THAT(input_files(file), ::testing::Contains(folder.path() / "torus.glb"));
  const auto models = load_models(file);
  SceneNodes nodes(file, models);
  nodes.place("box", glm::dmat4(1.0));
  const pipeline::Scene scene = nodes.scene();
  ASSERT_EQ(scene.objects.size(), 2u);
  const bool torus_first = scene.objects[0].name == "torus";
  const pipeline::Object &torus = scene.objects[torus_first ? 0 : 1],
                         &second = scene.objects[torus_first ? 1 : 0];
  EXPECT_EQ(torus.model, models[0].model);
  EXPECT_EQ(torus.shadow_model, models[0].shadow_model);
  EXPECT_FALSE(torus.casts_as_drawn());
  // Twice what was measured, if the file does not say it.
  EXPECT_GT(torus.shadow_displace, 0.0f);
  EXPECT_EQ(
      torus.shadow_displace,
      static_cast<float>(2.0 * pipeline::surface_distance(*torus.model, *torus.shadow_model)));
  EXPECT_EQ(second.shadow_displace, 0.0f);
  const SceneFile by_hand =
      folder.read(replaced(toml, "shadow_model = \"torus.glb\"\n",
                           "shadow_model = \"torus.glb\"\nshadow_displace_m = 0.25\n"));
  EXPECT_EQ(load_models(by_hand)[0].shadow_displace, 0.25f);
  // One file is one model: the object casts as it is drawn.
  EXPECT_EQ(second.model, torus.shadow_model);
  EXPECT_TRUE(second.casts_as_drawn());
}

TEST(SceneFile, MistakesAboutAShadowModelAreNamedByLineAndValue) {
  const SceneFolder folder;
  write_file(folder.path() / "empty.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  write_file(folder.path() / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 3\nf 1 1 2\n");
  write_file(folder.path() / "broken.glb", "glTF and no more");
  const auto message = [&](const std::string& keys) -> std::string {
    try {
      load_models(folder.read(
          replaced(kSmall, "model = \"torus.glb\"\n", "model = \"torus.glb\"\n" + keys)));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  };
  const std::string place = "scene.toml:12: [object 'torus'].shadow_model: ";
  EXPECT_THAT(message("shadow_model = \"no.glb\"\n"), HasSubstr(place + "no such file: "));
  EXPECT_THAT(message("shadow_model = 3\n"), HasSubstr(place + "3 is not a text in quotes"));
  EXPECT_THAT(message("shadow_model = \"torus.glb\"\ncasts = false\n"),
              HasSubstr(place + "together with casts = false"));
  for (const char* name : {"empty.obj", "flat.obj", "broken.glb", "camera.yml"}) {
    const std::string got = message("shadow_model = \"" + std::string(name) + "\"\n");
    EXPECT_THAT(got, HasSubstr(place)) << name;
    EXPECT_THAT(got, HasSubstr(name));
  }
  EXPECT_THAT(
      message("shadow_model = \"torus.glb\"\nshadow_displace_m = -1\n"),
      HasSubstr("scene.toml:13: [object 'torus'].shadow_displace_m: -1 is not within 0 to"));
  EXPECT_THAT(message("shadow_displace_m = 0.1\n"),
              HasSubstr("scene.toml:12: [object 'torus'].shadow_displace_m: without shadow_model"));
  EXPECT_THAT(message("shadow_mesh = \"torus.glb\"\n"), HasSubstr("].shadow_mesh: unknown key"));
}

}  // namespace
}  // namespace gnomon::ar
