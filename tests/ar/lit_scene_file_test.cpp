// Oracles: what was written, bit for bit; RFC 4648's test vectors; one broken rule at a time.
#include "ar/lit_scene_file.h"

#include <bit>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../pipeline/patch_rooms.h"
#include "ar/base64.h"
#include "ar/error.h"
#include "pipeline/sun.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

pipeline::LitScene small_scene() {
  pipeline::LitScene scene;
  scene.model = pipeline::make_patches(cube_room(), 50);
  pipeline::add_sun(scene.model, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {2, 1});
  scene.model.surfaces[0] = "l\"eft\n\xc3\xa4";
  for (std::size_t i = 0; i < scene.model.patches.size(); ++i) {
    const float f = 0.1f * static_cast<float>(i);
    scene.radiance.emplace_back(f, 1.0f / (1.0f + f), std::numeric_limits<float>::denorm_min());
    scene.reflectance.emplace_back(0.3f, 0.0f, 1.0f);
  }
  scene.tone = pipeline::ToneCurve::from_gamma(2.2, 1.0);
  scene.probe.width = 4;
  scene.probe.height = 2;
  scene.probe.center = {0.1f, -0.2f, 0.3f};
  for (int i = 0; i < 8; ++i)
    scene.probe.radiance.emplace_back(1e-20f, 1e20f, 0.1f * static_cast<float>(i));
  return scene;
}

class LitSceneFile : public testing::Test {
 protected:
  LitSceneFile() { write_lit_scene(path_, small_scene()); }
  json document() const { return json::parse(std::ifstream(path_)); }
  std::string error_of_text(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      read_lit_scene(path_);
    } catch (const InputError& e) {
      const std::string what = e.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      EXPECT_THAT(what, HasSubstr(path_.string()));
      return what;
    }
    return "no error";
  }
  std::string error_of(const json& document) const { return error_of_text(document.dump()); }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "scene.lit";
};

TEST_F(LitSceneFile, ComesBackToTheBit) {
  const pipeline::LitScene expected = small_scene(), got = read_lit_scene(path_);
  EXPECT_EQ(got.model.surfaces, expected.model.surfaces);
  EXPECT_EQ(got.model.longest_edge_m, expected.model.longest_edge_m);
  ASSERT_EQ(got.model.vertices.size(), expected.model.vertices.size());
  for (std::size_t i = 0; i < got.model.vertices.size(); ++i) {
    EXPECT_EQ(got.model.vertices[i].position, expected.model.vertices[i].position);
    EXPECT_EQ(got.model.vertices[i].normal, expected.model.vertices[i].normal);
  }
  ASSERT_EQ(got.model.patches.size(), expected.model.patches.size());
  for (std::size_t i = 0; i < got.model.patches.size(); ++i) {
    const pipeline::Patch &a = got.model.patches[i], &b = expected.model.patches[i];
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.center, b.center);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.area_m2, b.area_m2);
    EXPECT_EQ(a.surface, b.surface);
    EXPECT_EQ(a.distant, b.distant);
  }
  EXPECT_EQ(got.model.clear_surfaces, expected.model.clear_surfaces);
  EXPECT_EQ(got.radiance, expected.radiance);
  EXPECT_EQ(got.reflectance, expected.reflectance);
  EXPECT_EQ(got.tone.radiance_from_value, expected.tone.radiance_from_value);
  EXPECT_EQ(got.probe.width, 4);
  EXPECT_EQ(got.probe.center, expected.probe.center);
  EXPECT_EQ(got.probe.radiance, expected.probe.radiance);
}

TEST_F(LitSceneFile, RefusesAnotherFormatOrVersion) {
  json d = document();
  d["version"] = 1;
  EXPECT_THAT(error_of(d), HasSubstr("version: is not 2"));
  d["format"] = "another";
  EXPECT_THAT(error_of(d), HasSubstr("format: is not \"gnomon lit scene\""));
  EXPECT_THAT(error_of_text("[]"), HasSubstr("not a JSON object"));
  EXPECT_THAT(error_of_text(""), HasSubstr("not a JSON object"));
  EXPECT_THAT(error_of_text(std::string(200000, '[')), HasSubstr("not a JSON object"));
}

TEST_F(LitSceneFile, RefusesEveryMissingOrMistypedMember) {
  const json whole = document();
  for (const auto& [key, value] : whole.items()) {
    json d = whole;
    d.erase(key);
    EXPECT_NE(error_of(d), "no error") << key;
    d[key] = 7.5;
    EXPECT_NE(error_of(d), "no error") << key;
  }
  for (const char* part : {"model", "probe"})
    for (const auto& [key, value] : whole[part].items()) {
      json d = whole;
      d[part].erase(key);
      EXPECT_NE(error_of(d), "no error") << key;
      for (const json& wrong : {json(-1), json(nullptr), json("?"), json::array({-1})}) {
        d[part][key] = wrong;
        EXPECT_NE(error_of(d), "no error") << key << " = " << wrong;
      }
    }
}

TEST_F(LitSceneFile, RefusesSizesThatDoNotFitBeforeItTakesMemory) {
  const json whole = document();
  json d = whole;
  d["model"]["patches"] = 99999;
  EXPECT_THAT(error_of(d), HasSubstr("patch_vertices: is not base64 of 299997 numbers"));
  d["model"]["patches"] = 1000000000000;
  EXPECT_THAT(error_of(d), HasSubstr("patches: is not a whole number within 1 to 100000"));
  d = whole;
  d["probe"]["width"] = 5;
  EXPECT_THAT(error_of(d), HasSubstr("radiance: is not base64 of 30 numbers"));
}

TEST_F(LitSceneFile, RefusesNumbersOutOfTheirRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto with = [&](const char* key, std::size_t at, float value) {
    json d = document();
    auto values = *floats_from_base64(d[key].get<std::string>());
    values[at] = value;
    d[key] = base64_from_floats(values);
    return error_of(d);
  };
  EXPECT_THAT(with("radiance", 4, nan), HasSubstr("radiance: number 4 is nan"));
  write_lit_scene(path_, small_scene());
  EXPECT_THAT(with("radiance", 0, -1.0f), HasSubstr("radiance: number 0 is -1"));
  write_lit_scene(path_, small_scene());
  EXPECT_THAT(with("reflectance", 2, 1.5f), HasSubstr("reflectance: number 2 is 1.5"));
  write_lit_scene(path_, small_scene());
  EXPECT_THAT(with("tone", 300, 0.0f), HasSubstr("tone: number 300 does not rise"));
}

TEST_F(LitSceneFile, RefusesIndicesWithoutATargetAndPatchesWithoutArea) {
  const json whole = document();
  auto corners = *integers_from_base64(whole["model"]["patch_vertices"].get<std::string>());
  json d = whole;
  corners[7] = 4000000000u;
  d["model"]["patch_vertices"] = base64_from_integers(corners);
  EXPECT_THAT(error_of(d), HasSubstr("patch_vertices: number 7 is 4000000000, not below"));
  corners[7] = corners[6];
  d["model"]["patch_vertices"] = base64_from_integers(corners);
  EXPECT_THAT(error_of(d), HasSubstr("patch 2 has no area"));
}

TEST(Base64, HasTheVectorsOfItsRfc) {
  // "foob" and "foobar" + "ba" as numbers of four bytes.
  EXPECT_EQ(base64_from_integers(std::vector<std::uint32_t>{0x626f6f66u}), "Zm9vYg==");
  EXPECT_EQ(base64_from_integers(std::vector<std::uint32_t>{0x626f6f66u, 0x61627261u}),
            "Zm9vYmFyYmE=");
  EXPECT_EQ(base64_from_floats({}), "");
  EXPECT_EQ(integers_from_base64("Zm9vYmFyYmE="),
            (std::vector<std::uint32_t>{0x626f6f66u, 0x61627261u}));
  EXPECT_EQ(integers_from_base64(""), std::vector<std::uint32_t>());
  for (const char* wrong : {"Zm9v", "Zm9vYg=", "Zm9vYh==", "Zm9vY===", "Zm9 Yg==", "Zg==Yg=="})
    EXPECT_FALSE(integers_from_base64(wrong)) << wrong;
}

}  // namespace
}  // namespace gnomon::ar
