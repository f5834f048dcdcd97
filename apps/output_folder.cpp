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

void check_frame_target(const fs::path& frame, const std::vector<fs::path>& inputs) {
  if (frame.empty()) return;
  std::error_code error;
  const fs::path folder = fs::absolute(frame).parent_path();
  if (!fs::is_directory(folder, error))
    throw ar::InputError("--save-frame " + frame.string() + ": no folder " + folder.string());
  check_folder(folder);
  if (frame.extension() == ".png")
    throw ar::InputError("--save-frame " + frame.string() +
                         ": a frame is no picture; name a file that does not end in .png");
  if (fs::exists(frame, error) && !fs::is_regular_file(frame, error))
    throw ar::InputError("--save-frame " + frame.string() + ": is there and no regular file");
  for (const fs::path& input : inputs) refuse_to_replace(input, frame);
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
