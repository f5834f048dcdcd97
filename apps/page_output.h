// A page as a file.
#pragma once

#include <filesystem>
#include <string>

namespace gnomon::apps {

/// Before any work: could the page be written? Throws ar::InputError if not.
void check_page_folder(const std::filesystem::path& page);

/// Writes it, makes its folder if that is not there, and says so. Throws ar::InputError.
void write_page(const std::filesystem::path& page, const std::string& text);

}  // namespace gnomon::apps
