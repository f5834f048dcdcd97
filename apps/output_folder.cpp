#include "apps/output_folder.h"

#include <unistd.h>

#include <system_error>

#include "ar/error.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

void check_folder(const fs::path& out) {
  if (out.empty()) throw ar::InputError("--out: a folder's name is empty");
  std::error_code error;
  fs::path existing = fs::absolute(out, error);
  while (!fs::exists(existing, error) && existing.has_relative_path())
    existing = existing.parent_path();
  if (!fs::is_directory(existing, error))
    throw ar::InputError(existing.string() + ": not a folder, so nothing can be written to " +
                         out.string());
  if (access(existing.c_str(), W_OK | X_OK) != 0)
    throw ar::InputError(existing.string() + ": this folder cannot be written");
}

void refuse_to_replace(const fs::path& input, const fs::path& output) {
  std::error_code error;
  if (fs::equivalent(input, output, error))
    throw ar::InputError(output.string() + ": is the input itself; name another folder");
}

void make_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error || !fs::is_directory(out))
    throw ar::InputError(out.string() + ": cannot make this folder: " +
                         (error ? error.message() : "a file has its name"));
  if (access(out.c_str(), W_OK | X_OK) != 0)
    throw ar::InputError(out.string() + ": this folder cannot be written");
}

}  // namespace gnomon::apps
