#include "apps/inspector/lab_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

namespace gnomon::apps::inspector {

using nlohmann::ordered_json;

namespace {

constexpr std::string_view kFormat = "gnomon-lab";
constexpr int kVersion = 1;
/// Lists and objects in each other, of which a state has one.
constexpr int kDeepest = 8;

/// At least as deep as the text's lists and objects go; brackets inside of strings count too.
int nesting(std::string_view json) {
  int depth = 0, deepest = 0;
  for (const char c : json) {
    if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
    if (c == ']' || c == '}') --depth;
  }
  return deepest;
}

constexpr std::array<std::string_view, 5> kStages{"camera-in-shadow", "missing-cap", "overflow",
                                                  "open-mesh", "acne"};
constexpr std::array<std::string_view, 4> kMethods{"zpass", "zfail", "auto", "map"};

/// Calls io once for each field but the stage, with its name and bounds.
template <class Io, class State>
void fields(Io& io, State& s) {
  io.integer("width", s.width, 16, 1920);
  io.integer("height", s.height, 16, 1920);
  io.real("camera_turn_deg", s.camera_turn_deg, -360.0, 360.0);
  io.real("camera_tilt_deg", s.camera_tilt_deg, -20.0, 89.0);
  io.real("camera_distance_m", s.camera_distance_m, 0.2, 30.0);
  io.real("light_x_m", s.light_x_m, -20.0, 20.0);
  io.real("light_y_m", s.light_y_m, -20.0, 20.0);
  io.real("light_z_m", s.light_z_m, -20.0, 20.0);
  io.real("object_x_m", s.object_x_m, -10.0, 10.0);
  io.real("object_y_m", s.object_y_m, -10.0, 10.0);
  io.real("object_z_m", s.object_z_m, -10.0, 10.0);
  io.real("object_turn_deg", s.object_turn_deg, -360.0, 360.0);
  io.choice("method", s.method, kMethods);
  io.flag("saturate", s.saturate);
  io.flag("front_cap", s.front_cap);
  io.flag("back_cap", s.back_cap);
  io.real("length_m", s.length_m, 0.0, 100.0);
  io.flag("classical_outline", s.classical_outline);
  io.integer("plates", s.plates, 1, 600);
  io.integer("map_size", s.map_size, 16, 2048);
  io.real("map_offset_factor", s.map_offset_factor, 0.0, 100.0);
  io.real("map_offset_units", s.map_offset_units, 0.0, 100000.0);
  io.flag("map_filtered", s.map_filtered);
  io.flag("depth_16_bits", s.depth_16_bits);
}

class Writer {
 public:
  explicit Writer(ordered_json& out) : out_(out) {}
  void integer(const char* name, int value, int, int) { out_[name] = value; }
  void real(const char* name, double value, double, double) { out_[name] = value; }
  void flag(const char* name, bool value) { out_[name] = value; }
  template <class Enum, std::size_t kCount>
  void choice(const char* name, Enum value, const std::array<std::string_view, kCount>& names) {
    out_[name] = names.at(static_cast<std::size_t>(value));
  }

 private:
  ordered_json& out_;
};

/// Of a list or an object only what it is: its text is as deep as someone else made it.
std::string text_of(const ordered_json& value) {
  if (value.is_array()) return "a list";
  if (value.is_object()) return "an object";
  return value.dump(-1, ' ', true, ordered_json::error_handler_t::replace).substr(0, 60);
}

/// Takes what is there out of the object, so that what is left is not known.
class Reader {
 public:
  explicit Reader(ordered_json& in) : in_(in) {}

  void integer(const char* name, int& value, int low, int high) {
    take(name, [&](const ordered_json& given) {
      const bool fits = given.is_number_integer() && given >= low && given <= high;
      require(fits, name, given,
              "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
      value = given.template get<int>();
    });
  }
  void real(const char* name, double& value, double low, double high) {
    take(name, [&](const ordered_json& given) {
      const bool fits = given.is_number() && given >= low && given <= high;
      require(fits, name, given,
              "a number from " + text_of(ordered_json(low)) + " to " + text_of(ordered_json(high)));
      value = given.template get<double>();
    });
  }
  void flag(const char* name, bool& value) {
    take(name, [&](const ordered_json& given) {
      require(given.is_boolean(), name, given, "true or false");
      value = given.template get<bool>();
    });
  }
  template <class Enum, std::size_t kCount>
  void choice(const char* name, Enum& value, const std::array<std::string_view, kCount>& names) {
    take(name, [&](const ordered_json& given) {
      std::string known;
      for (std::size_t i = 0; i < kCount; ++i) {
        if (given == names[i]) value = static_cast<Enum>(i);
        known += (i ? ", " : "one of ") + std::string(names[i]);
      }
      require(given.is_string() && given == names.at(static_cast<std::size_t>(value)), name, given,
              known);
    });
  }

 private:
  template <class Read>
  void take(const char* name, Read read) {
    const auto found = in_.find(name);
    if (found == in_.end()) return;
    read(*found);
    in_.erase(found);
  }
  static void require(bool holds, const char* name, const ordered_json& given,
                      const std::string& wanted) {
    if (!holds)
      throw LabError(std::string("'") + name + "' is " + text_of(given) + ", not " + wanted);
  }

  ordered_json& in_;
};

}  // namespace

LabState starting_state(LabStage stage) {
  LabState state;
  state.stage = stage;
  switch (stage) {
    case LabStage::camera_in_shadow:
      state.method = LabMethod::zpass;
      break;
    case LabStage::missing_cap:
      state.method = LabMethod::zpass;
      state.length_m = 0.9;
      state.back_cap = false;
      state.camera_tilt_deg = 12.0;
      break;
    case LabStage::overflow:
      state.plates = 256;
      state.camera_tilt_deg = 32.0;
      state.light_x_m = 0.0;
      state.light_z_m = 0.0;
      state.light_y_m = 8.0;
      break;
    case LabStage::open_mesh:
      state.classical_outline = true;
      break;
    case LabStage::acne:
      state.method = LabMethod::shadow_map;
      break;
  }
  return state;
}

LabState read_lab_state(std::string_view json) {
  if (nesting(json) > kDeepest) throw LabError("this is no state: it is nested too deeply");
  ordered_json in = ordered_json::parse(json, nullptr, false);
  if (!in.is_object()) throw LabError("this is no JSON object");
  const auto format = in.find("format"), version = in.find("version");
  if (format == in.end() || *format != kFormat) throw LabError("'format' is not \"gnomon-lab\"");
  if (version == in.end() || *version != kVersion)
    throw LabError("'version' is " + (version == in.end() ? "missing" : text_of(*version)) +
                   "; version 1 can be read");
  in.erase("format");
  in.erase("version");
  Reader reader(in);
  LabStage stage = LabStage::camera_in_shadow;
  reader.choice("stage", stage, kStages);
  LabState state = starting_state(stage);
  fields(reader, state);
  if (!in.empty()) throw LabError("there is no field '" + in.begin().key().substr(0, 60) + "'");
  return state;
}

std::string to_json(const LabState& state) {
  ordered_json out{{"format", kFormat}, {"version", kVersion}};
  Writer writer(out);
  writer.choice("stage", state.stage, kStages);
  fields(writer, state);
  return out.dump(2);
}

}  // namespace gnomon::apps::inspector
