#include "ar/scene_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/model_writer.h"
#include "ar/toml_table.h"

namespace gnomon::ar {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxSceneBytes = 1 << 20;

/// Names in files: letters, digits, - and _; what else there is becomes _.
std::string file_name(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, 60)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    out += plain ? c : '_';
  }
  return out;
}

void set(toml::table& table, std::string_view key, auto value) {
  table.insert_or_assign(key, std::move(value));
}

/// Writes the models that are new, each once.
class ModelFolder {
 public:
  explicit ModelFolder(fs::path folder) : folder_(std::move(folder)) {}

  /// The path as the scene file says it.
  std::string write(const std::string& name, const std::shared_ptr<const pipeline::Model>& model) {
    auto& path = written_[model];
    if (!path.empty()) return path;
    std::string free = file_name(name);
    for (int n = 2; !names_.insert(free).second; ++n)
      free = fmt::format("{}_{}", file_name(name), n);
    std::error_code error;
    fs::create_directories(folder_ / "models", error);
    path = "models/" + free + ".glb";
    PendingFile file(folder_ / path);
    write_model(file.temporary(), *model);
    file.commit();
    return path;
  }

 private:
  fs::path folder_;
  std::set<std::string> names_;
  std::map<std::shared_ptr<const pipeline::Model>, std::string> written_;
};

bool is_of_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
         c == '_' || c == '+';
}

/// The text with each number in its fewest digits: toml++ writes 0.1 as 0.10000000000000001.
std::string with_short_numbers(const std::string& text) {
  std::string out;
  char quote = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (quote == 0 && (c == '\'' || c == '"'))
      quote = c;
    else if (c == quote)
      quote = 0;
    else if (quote == '"' && c == '\\')
      out += text[i++];
    const bool begins = quote == 0 && c >= '0' && c <= '9' && (i == 0 || !is_of_word(text[i - 1]));
    std::size_t end = i + 1;
    while (begins && end < text.size() && is_of_word(text[end])) ++end;
    const std::string_view word(text.data() + i, end - i);
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (begins && word.find('.') != word.npos && error == std::errc() &&
        rest == word.data() + word.size()) {
      std::string digits = fmt::format("{}", value);
      // A float stays one when it is read.
      if (digits.find_first_of(".e") == digits.npos) digits += ".0";
      out += digits.size() < word.size() ? digits : std::string(word);
      i = end;
    } else {
      out += text[i++];
    }
  }
  return out;
}

class Writer {
 public:
  Writer(const FitScene& given, const FitScene& fitted, const fs::path& folder,
         const fs::path& lives_in)
      : given_(given),
        fitted_(fitted),
        folder_(folder),
        from_(fs::weakly_canonical(fs::absolute(given.file.file).parent_path())),
        to_(fs::weakly_canonical(fs::absolute(lives_in))),
        root_(load_toml(given.file.file, kMaxSceneBytes, kSceneFormat)),
        models_(folder) {}

  void write() {
    move_paths();
    edit_objects();
    edit_lights();
    edit_casters();
    if (fitted_.file.samples != given_.file.samples && root_["camera"].is_table())
      set(*root_["camera"].as_table(), "samples", fitted_.file.samples);
    edit_shadow();
    edit_differential();
    std::ostringstream text;
    text << root_ << '\n';
    write_file(folder_ / "scene.toml",
               fmt::format("# Written by gnomon fit from {}: what the scene needs within its bound "
                           "(docs/fit.md).\n# Comments of that file are not here.\n{}",
                           one_line(given_.file.file.filename().string()),
                           with_short_numbers(text.str())));
  }

 private:
  std::string moved(const fs::path& path) const {
    const fs::path whole = fs::weakly_canonical(from_ / path);
    const fs::path relative = whole.lexically_relative(to_);
    return (relative.empty() ? whole : relative).generic_string();
  }

  void move_path(toml::node* table, std::string_view key) const {
    if (table == nullptr || !table->is_table()) return;
    const auto path = (*table->as_table())[key].value<std::string>();
    if (path) set(*table->as_table(), key, moved(*path));
  }

  void move_paths() {
    move_path(root_.get("camera"), "file");
    move_path(root_.get("detection"), "response");
    move_path(root_.get("tags_yaml"), "file");
    move_path(root_.get("differential"), "lit_scene");
    for (const auto& [array, key] : {std::pair{"dictionary", "file"},
                                     {"object", "model"},
                                     {"object", "shadow_model"},
                                     {"light", "model"}})
      if (toml::array* tables = root_[array].as_array())
        for (toml::node& table : *tables) move_path(&table, key);
  }

  void edit_object(toml::table& table, const FitObject& before, const FitObject& after) {
    const std::string name = table["name"].value_or(std::string("object"));
    if (after.models.model != before.models.model)
      set(table, "model", models_.write(name, after.models.model));
    if (after.casts != before.casts) set(table, "casts", after.casts);
    if (after.casts && after.models.shadow_model == before.models.shadow_model) return;
    table.erase("shadow_model");
    table.erase("shadow_displace_m");
    if (!after.casts || !after.models.shadow_model) return;
    set(table, "shadow_model", models_.write(name + "_shadow", after.models.shadow_model));
    set(table, "shadow_displace_m", static_cast<double>(after.models.shadow_displace));
  }

  void edit_objects() {
    toml::array& tables = *root_["object"].as_array();
    // From the end, since some go.
    for (std::size_t i = tables.size(); i-- > 0;) {
      if (fitted_.objects[i].kept)
        edit_object(*tables[i].as_table(), given_.objects[i], fitted_.objects[i]);
      else
        tables.erase(tables.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void edit_lights() {
    for (std::size_t i = 0; i < fitted_.file.lights.size(); ++i)
      if (fitted_.file.lights[i].samples != given_.file.lights[i].samples)
        set(*(*root_["light"].as_array())[i].as_table(), "samples", fitted_.file.lights[i].samples);
  }

  bool is_dropped(const std::string& name) const {
    for (std::size_t i = 0; i < fitted_.objects.size(); ++i)
      if (fitted_.file.objects[i].name == name) return !fitted_.objects[i].kept;
    return false;
  }

  /// Where tables change or go, all are written anew, light by light.
  void edit_casters() {
    const std::vector<SceneCaster>& casters = fitted_.file.casters;
    const auto gone = [this](const SceneCaster& caster) { return is_dropped(caster.node); };
    if (casters == given_.file.casters && std::ranges::none_of(casters, gone)) return;
    toml::array tables;
    for (const pipeline::Light& light : fitted_.file.lights) {
      bool any = false;
      for (const SceneCaster& caster : casters) {
        if (caster.light != light.name || gone(caster)) continue;
        tables.push_back(caster_table(caster));
        any = true;
      }
      // A light that no table speaks of has the shadows of all objects.
      if (!any)
        tables.push_back(
            caster_table({.light = light.name, .method = pipeline::ShadowMethod::none}));
    }
    set(root_, "caster", std::move(tables));
  }

  static toml::table caster_table(const SceneCaster& caster) {
    toml::table table;
    if (!caster.node.empty()) set(table, "node", caster.node);
    if (!caster.light.empty()) set(table, "light", caster.light);
    constexpr const char* kNames[] = {"volumes", "map", "alias-free", "none"};
    set(table, "method", std::string(kNames[static_cast<std::size_t>(caster.method)]));
    if (caster.method == pipeline::ShadowMethod::map) set_map(table, caster.map);
    return table;
  }

  static void set_map(toml::table& table, const pipeline::MapSettings& map) {
    if (map.size) set(table, "size", *map.size);
    if (map.sides != pipeline::MapSides::automatic)
      set(table, "sides", map.sides == pipeline::MapSides::one ? 1 : 6);
    if (map.fov_tangent)
      set(table, "fov_deg", glm::degrees(2.0 * std::atan(static_cast<double>(*map.fov_tangent))));
    if (map.near_far_m) {
      set(table, "near_m", static_cast<double>(map.near_far_m->x));
      set(table, "far_m", static_cast<double>(map.near_far_m->y));
    }
    if (map.offset) {
      set(table, "displace_scale", static_cast<double>(map.offset->factor));
      set(table, "displace_offset", static_cast<double>(map.offset->units));
    }
    if (map.filter == raster::Filter::linear) set(table, "filter", std::string("linear"));
    if (map.format == raster::DepthFormat::d16) set(table, "depth_bits", 16);
  }

  toml::table& table_of(std::string_view name) {
    if (!root_.contains(name)) set(root_, name, toml::table{});
    return *root_[name].as_table();
  }

  void edit_shadow() {
    const ShadowSettings &before = given_.file.shadow, &after = fitted_.file.shadow;
    if (after.method != before.method) {
      constexpr const char* kNames[] = {"auto", "zpass", "zfail"};
      set(table_of("shadow"), "method",
          std::string(kNames[static_cast<std::size_t>(after.method)]));
    }
    if (after.volume == before.volume) return;
    if (const double* radius_m = std::get_if<double>(&after.volume))
      set(table_of("shadow"), "volume", *radius_m);
    else
      set(table_of("shadow"), "volume",
          std::string(std::holds_alternative<InfiniteReach>(after.volume) ? "infinite" : "auto"));
  }

  void edit_differential() {
    if (!fitted_.file.differential) return;
    toml::table& table = table_of("differential");
    if (!fitted_.file.differential->lit_scene.empty())
      set(table, "lit_scene", moved(fs::absolute(fitted_.file.differential->lit_scene)));
    const DifferentialSettings &before = given_.file.differential->settings,
                               &after = fitted_.file.differential->settings;
    table.erase("budget_ms");
    set(table, "passes", static_cast<std::int64_t>(after.method.take.passes));
    if (after.light.transfer.power_share != before.light.transfer.power_share)
      set(table, "power_share", after.light.transfer.power_share);
    if (after.light.prune_share != before.light.prune_share)
      set(table, "prune_share", after.light.prune_share);
    if (after.occluder_triangles != before.occluder_triangles)
      set(table, "occluder_triangles", static_cast<std::int64_t>(after.occluder_triangles));
    if (after.method.take.precision != before.method.take.precision) {
      constexpr const char* kNames[] = {"bytes", "dithered", "values", "radiance"};
      set(table, "precision",
          std::string(kNames[static_cast<std::size_t>(after.method.take.precision)]));
    }
    const bool map = after.method.mask == pipeline::ShadowMask::map;
    if (after.method.mask != before.method.mask)
      set(table, "mask", std::string(map ? "map" : "volumes"));
    if (!map)
      table.erase("map_size");
    else if (after.method.map_size != before.method.map_size)
      set(table, "map_size", after.method.map_size);
  }

  const FitScene &given_, &fitted_;
  fs::path folder_, from_, to_;
  toml::table root_;
  ModelFolder models_;
};

}  // namespace

void write_fit_scene(const FitScene& given, const FitScene& fitted, const fs::path& folder,
                     const fs::path& lives_in) {
  Writer(given, fitted, folder, lives_in).write();
}

}  // namespace gnomon::ar
