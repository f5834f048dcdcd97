#include "apps/page_output.h"

#include <iostream>

#include <fmt/format.h>

#include "apps/output_folder.h"
#include "ar/file.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& page) {
  return page.has_parent_path() ? page.parent_path() : fs::path(".");
}

}  // namespace

void check_page_folder(const fs::path& page) { check_folder(folder_of(page)); }

void write_page(const fs::path& page, const std::string& text) {
  make_folder(folder_of(page));
  ar::write_file(page, text);
  std::cout << fmt::format("wrote {} ({:.1f} MB)\n", page.string(),
                           static_cast<double>(text.size()) * 1e-6);
}

}  // namespace gnomon::apps
