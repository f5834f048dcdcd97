#include "pipeline/scene_graph.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "pipeline/general_method.h"
#include "raster/execute.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 160, kHeight = 120;

NodePointer geometry(std::string name, Mesh mesh, const glm::dvec3& at = glm::dvec3(0.0)) {
  NodePointer node = make_node(std::move(name), glm::translate(glm::dmat4(1.0), at));
  node->content = Geometry{.model = test::model_of(std::move(mesh))};
  return node;
}

NodePointer lamp(std::string name, const glm::vec4& position) {
  NodePointer node = make_node(std::move(name));
  node->content = LightSource{{.position = position}};
  return node;
}

NodePointer shadow(NodePointer caster, NodePointer light, ShadowMethod method) {
  NodePointer node = make_node("shadow");
  node->content = Shadow{std::move(caster), std::move(light), method};
  return node;
}

/// A plate, and above it a group of a box and a ball, under a lamp and a sun.
struct Graph {
  NodePointer root = make_node("root");
  NodePointer plate = geometry("plate", test::square_mesh(3.0f));
  NodePointer group = make_node("group", glm::translate(glm::dmat4(1.0), {0.0, 1.0, 0.0}));
  NodePointer box = geometry("box", test::box_mesh(glm::vec3(0.3f)), {-0.6, 0.0, 0.0});
  NodePointer ball = geometry("ball", test::icosphere_mesh(0.3f, 2), {0.6, 0.0, 0.0});
  NodePointer lamp1 = lamp("lamp", {0.0f, 4.0f, 0.0f, 1.0f});
  NodePointer sun = lamp("sun", {0.0f, 1.0f, 0.0f, 0.0f});

  Graph() {
    group->children = {box, ball};
    root->children = {plate, group, lamp1, sun};
  }
};

raster::ColorBuffer picture_of(const Scene& scene) {
  raster::ColorBuffer color(kWidth, kHeight);
  raster::DepthBuffer depth(kWidth, kHeight);
  raster::StencilBuffer stencil(kWidth, kHeight);
  MapMemory maps;
  raster::execute(record_general(scene,
                                 test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight),
                                 {&color, &depth, &stencil}, {.maps = &maps}));
  return color;
}

void expect_refused(const Node& root, const std::string& what) {
  try {
    flatten(root);
    FAIL() << "not refused: " << what;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
  }
}

TEST(SceneGraph, PlacesNodesByTheProductOfTheirTransforms) {
  Graph graph;
  graph.group->parent_from_node =
      glm::rotate(graph.group->parent_from_node, std::acos(0.0), glm::dvec3(0.0, 1.0, 0.0));
  graph.group->children.push_back(graph.lamp1);
  graph.root->children.pop_back();
  graph.root->children.pop_back();
  const Scene scene = flatten(*graph.root);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[1].name, "box");
  // A quarter about y takes -x to +z.
  const glm::vec3 box(scene.objects[1].world_from_model[3]);
  EXPECT_NEAR(box.x, 0.0f, 1e-6f);
  EXPECT_NEAR(box.y, 1.0f, 1e-6f);
  EXPECT_NEAR(box.z, 0.6f, 1e-6f);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  EXPECT_EQ(scene.lights[0].position, glm::vec4(0.0f, 5.0f, 0.0f, 1.0f));
}

TEST(SceneGraph, ALightWithoutAShadowNodeHasTheShadowsOfAll) {
  const Scene scene = flatten(*Graph().root);
  for (const Light& light : scene.lights) {
    EXPECT_TRUE(light.shadow_of_object.empty());
    EXPECT_EQ(light.shadow, ShadowMethod::volumes);
  }
}

TEST(SceneGraph, AShadowNodeTakesANodeOrASubTree) {
  Graph graph;
  graph.root->children.push_back(shadow(graph.group, graph.lamp1, ShadowMethod::map));
  graph.root->children.push_back(shadow(graph.ball, graph.sun, ShadowMethod::volumes));
  const Scene scene = flatten(*graph.root);
  using enum ShadowMethod;
  EXPECT_EQ(scene.lights[0].shadow_of_object, (std::vector{none, map, map}));
  EXPECT_EQ(scene.lights[1].shadow_of_object, (std::vector{none, none, volumes}));
}

TEST(SceneGraph, AShadowNodeWithoutALightIsForEveryLight) {
  Graph graph;
  graph.root->children.push_back(shadow(graph.box, nullptr, ShadowMethod::volumes));
  const Scene scene = flatten(*graph.root);
  for (const Light& light : scene.lights)
    EXPECT_EQ(light.shadow_of_object,
              (std::vector{ShadowMethod::none, ShadowMethod::volumes, ShadowMethod::none}));
}

TEST(SceneGraph, ANodeThatHangsTwiceIsThereTwice) {
  Graph graph;
  const NodePointer aside = make_node("aside", glm::translate(glm::dmat4(1.0), {0.0, 0.0, 1.0}));
  aside->children = {graph.box};
  graph.root->children.push_back(aside);
  graph.root->children.push_back(shadow(aside, nullptr, ShadowMethod::volumes));
  const Scene scene = flatten(*graph.root);
  ASSERT_EQ(scene.objects.size(), 4u);
  EXPECT_EQ(scene.objects[3].world_from_model[3], glm::vec4(-0.6f, 0.0f, 1.0f, 1.0f));
  // Only where it hangs under the caster.
  EXPECT_EQ(scene.lights[0].shadow_of_object[1], ShadowMethod::none);
  EXPECT_EQ(scene.lights[0].shadow_of_object[3], ShadowMethod::volumes);
}

// Oracle: the same scene built at the new place.
// Oracle: the graph whose group was built where the other one has moved to; byte for byte.
TEST(SceneGraph, AGeometrysShadowModelCastsInItsPlaceAndMovesWithIt) {
  const auto reduced = test::model_of(test::icosphere_mesh(0.3f, 0));
  for (const ShadowMethod method :
       {ShadowMethod::volumes, ShadowMethod::map, ShadowMethod::alias_free}) {
    Graph graph, elsewhere;
    for (Graph* each : {&graph, &elsewhere}) {
      each->root->children.push_back(shadow(each->group, nullptr, method));
      std::get<Geometry>(each->ball->content).shadow_model = reduced;
    }
    EXPECT_EQ(flatten(*graph.root).objects[2].shadow_model, reduced);
    EXPECT_TRUE(flatten(*graph.root).objects[1].casts_as_drawn());
    const auto before = picture_of(flatten(*graph.root)).to_rgba8_rows();
    graph.group->parent_from_node[3] += glm::dvec4(0.5, 0.25, 0.5, 0.0);
    elsewhere.group->parent_from_node = glm::translate(glm::dmat4(1.0), {0.5, 1.25, 0.5});
    const auto moved = picture_of(flatten(*graph.root)).to_rgba8_rows();
    EXPECT_EQ(moved, picture_of(flatten(*elsewhere.root)).to_rgba8_rows());
    EXPECT_NE(moved, before);
    std::get<Geometry>(graph.ball->content).shadow_model = nullptr;
    EXPECT_NE(moved, picture_of(flatten(*graph.root)).to_rgba8_rows());
  }
}

TEST(SceneGraph, MovingATransformMovesTheShadow) {
  for (const ShadowMethod method : {ShadowMethod::volumes, ShadowMethod::map}) {
    Graph graph, elsewhere;
    for (Graph* each : {&graph, &elsewhere})
      each->root->children.push_back(shadow(each->group, nullptr, method));
    const raster::ColorBuffer before = picture_of(flatten(*graph.root));
    graph.group->parent_from_node[3] += glm::dvec4(0.5, 0.25, 0.5, 0.0);
    elsewhere.group->parent_from_node = glm::translate(glm::dmat4(1.0), {0.5, 1.25, 0.5});
    const auto moved = picture_of(flatten(*graph.root)).to_rgba8_rows();
    EXPECT_EQ(moved, picture_of(flatten(*elsewhere.root)).to_rgba8_rows());
    EXPECT_NE(moved, before.to_rgba8_rows());
    // There is a shadow to be moved.
    std::get<Shadow>(graph.root->children.back()->content).method = ShadowMethod::none;
    EXPECT_NE(moved, picture_of(flatten(*graph.root)).to_rgba8_rows());
  }
}

// Oracle: a scene whose other objects do not cast at all.
TEST(SceneGraph, OnlyTheCasterOfAShadowNodeDarkens) {
  for (const ShadowMethod method : {ShadowMethod::volumes, ShadowMethod::map}) {
    Graph graph;
    graph.root->children.push_back(shadow(graph.ball, nullptr, method));
    Graph plain;
    for (const NodePointer& node : {plain.plate, plain.box})
      std::get<Geometry>(node->content).casts = false;
    for (const NodePointer& node : {plain.lamp1, plain.sun})
      std::get<LightSource>(node->content).light.shadow = method;
    const auto shadowed = picture_of(flatten(*graph.root)).to_rgba8_rows();
    EXPECT_EQ(shadowed, picture_of(flatten(*plain.root)).to_rgba8_rows());
    std::get<Shadow>(graph.root->children.back()->content).method = ShadowMethod::none;
    EXPECT_NE(shadowed, picture_of(flatten(*graph.root)).to_rgba8_rows());
  }
}

TEST(SceneGraph, WhatIsOffIsNotThere) {
  Graph graph;
  graph.root->children.push_back(shadow(graph.group, nullptr, ShadowMethod::map));
  graph.group->on = false;
  const Scene scene = flatten(*graph.root);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].name, "plate");
  EXPECT_EQ(scene.lights[0].shadow_of_object, (std::vector{ShadowMethod::none}));
}

TEST(SceneGraph, SpotsTurnWithTheirNode) {
  Graph graph;
  Light& light = std::get<LightSource>(graph.lamp1->content).light;
  light.spot_direction = {0.0f, -1.0f, 0.0f};
  light.spot_cos_cutoff = 0.9f;
  graph.lamp1->parent_from_node =
      glm::rotate(glm::dmat4(1.0), std::acos(0.0), glm::dvec3(0.0, 0.0, 1.0));
  const Scene scene = flatten(*graph.root);
  EXPECT_NEAR(scene.lights[0].spot_direction.x, 1.0f, 1e-6f);
  EXPECT_NEAR(scene.lights[0].position.x, -4.0f, 1e-6f);
}

TEST(SceneGraph, RefusesWhatIsNoGraph) {
  {
    Graph graph;
    graph.box->children = {graph.group};
    expect_refused(*graph.root, "node 'group': it contains itself");
    graph.box->children.clear();
    graph.box->children = {nullptr};
    expect_refused(*graph.root, "node 'box': a child is null");
  }
  {
    Graph graph;
    graph.box->parent_from_node[0][0] = std::nan("");
    expect_refused(*graph.root, "node 'box': its transform is not finite");
    graph.box->parent_from_node = glm::dmat4(0.0);
    expect_refused(*graph.root, "node 'box': its transform cannot be inverted");
  }
  {
    Graph graph;
    std::get<Geometry>(graph.box->content).model = nullptr;
    expect_refused(*graph.root, "node 'box': a geometry has a model");
  }
  NodePointer deep = make_node("end");
  for (int i = 0; i < 1001; ++i) {
    NodePointer above = make_node("link");
    above->children = {deep};
    deep = above;
  }
  expect_refused(*deep, "1000 nodes deep");
}

TEST(SceneGraph, RefusesShadowsThatContradict) {
  {
    Graph graph;
    graph.root->children.push_back(shadow(make_node("else"), nullptr, ShadowMethod::map));
    expect_refused(*graph.root, "its caster is not in the graph");
  }
  {
    Graph graph;
    graph.root->children.push_back(shadow(graph.box, graph.ball, ShadowMethod::map));
    expect_refused(*graph.root, "its light is a node without a light");
  }
  {
    Graph graph;
    graph.root->children.push_back(shadow(graph.box, nullptr, ShadowMethod::map));
    graph.root->children.push_back(shadow(graph.group, graph.sun, ShadowMethod::volumes));
    expect_refused(*graph.root, "another method");
  }
  {
    Graph graph;
    graph.root->children.push_back(shadow(graph.box, nullptr, ShadowMethod::map));
    NodePointer other = shadow(graph.ball, nullptr, ShadowMethod::map);
    std::get<Shadow>(other->content).map.size = 64;
    graph.root->children.push_back(other);
    expect_refused(*graph.root, "other settings");
  }
}

}  // namespace
}  // namespace gnomon::pipeline
