#include "apps/study/study_file.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/toml_table.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMaxStudyBytes = 1 << 20;

StudyPhotograph read_photograph(const fs::path& file, const toml::table& table) {
  const ar::TomlTable t(
      file, table, "[[photograph]]",
      {"name", "scene", "photograph", "truth", "shadow_mask", "object_mask", "capture"});
  StudyPhotograph out;
  out.name = t.required("name", t.text("name"));
  out.scene = t.required("scene", t.file("scene"));
  out.photograph = t.required("photograph", t.file("photograph"));
  out.truth = t.required("truth", t.file("truth"));
  out.shadow_mask = t.file("shadow_mask").value_or("");
  out.object_mask = t.file("object_mask").value_or("");
  if (const auto folder = t.text("capture")) {
    out.capture = file.parent_path() / *folder;
    if (!fs::is_directory(out.capture)) t.fail("capture", "there is no folder '" + *folder + "'");
  }
  return out;
}

}  // namespace

bool is_study(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = ar::read_file(file, kMaxStudyBytes);
  try {
    const toml::table parsed =
        toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    return parsed["format"].value_or(std::string_view()).starts_with("gnomon-study");
  } catch (const toml::parse_error&) {
    return false;
  }
}

Study read_study(const fs::path& file) {
  const toml::table document = ar::load_toml(file, kMaxStudyBytes, kStudyFormat);
  const ar::TomlTable t(file, document, "", {"format", "photograph", "scenes"});
  Study study;
  for (const toml::table* table : t.tables("photograph")) {
    study.photographs.push_back(read_photograph(file, *table));
    const auto same = [&](const StudyPhotograph& p) {
      return p.name == study.photographs.back().name;
    };
    if (std::ranges::count_if(study.photographs, same) > 1)
      ar::fail_at(file, *table,
                  fmt::format("[[photograph]].name: '{}' is there twice",
                              ar::one_line(study.photographs.back().name)));
  }
  for (const std::string& scene : t.texts("scenes").value_or(std::vector<std::string>{})) {
    study.scenes.push_back(file.parent_path() / scene);
    if (!fs::exists(study.scenes.back()))
      t.fail("scenes", "there is no file '" + ar::one_line(scene) + "'");
  }
  if (study.photographs.empty() && study.scenes.empty())
    t.fail("photograph", "neither this nor scenes is there, so there is nothing to chart");
  return study;
}

}  // namespace gnomon::apps::study
