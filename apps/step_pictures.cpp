#include "apps/step_pictures.h"

#include <cctype>
#include <string>

#include <fmt/format.h>

#include "apps/output_folder.h"
#include "ar/image_file.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

/// "step 2: volumes of ..." as part of a file name.
std::string file_name_of(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  std::string name;
  for (const char c : label)
    if (c != '_' || (!name.empty() && name.back() != '_')) name += c;
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

}  // namespace

void write_steps(const fs::path& out, const std::vector<ar::PassPictures>& steps) {
  const fs::path folder = out / "steps";
  make_folder(folder);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string name = fmt::format("{:02}_{}", i + 1, file_name_of(steps[i].label));
    ar::write_png(folder / (name + "_color.png"), steps[i].color);
    ar::write_png(folder / (name + "_depth.png"), steps[i].depth);
    ar::write_png(folder / (name + "_stencil.png"), steps[i].stencil);
  }
}

}  // namespace gnomon::apps
