#include "apps/study/page_image.h"

#include "ar/base64.h"
#include "ar/image_file.h"

namespace gnomon::apps::study {

namespace {

constexpr int kJpegQuality = 85;

}  // namespace

std::size_t PageImages::add(const std::string& name) {
  const auto [at, fresh] = known_.try_emplace(name, uris_.size());
  if (fresh) {
    const ar::Image small = shrunk(ar::read_image_rgb(folder_ / name), kWidth);
    uris_.push_back("data:image/jpeg;base64," +
                    ar::base64_from_bytes(ar::encode_jpeg(small, kJpegQuality, name)));
  }
  return at->second;
}

ar::Image shrunk(const ar::Image& picture, int width) {
  const int by = (picture.width + width - 1) / width;
  if (by <= 1) return picture;
  ar::Image out{picture.width / by, std::max(picture.height / by, 1), picture.channels, {}};
  const int rows = std::min(by, picture.height);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      for (int c = 0; c < out.channels; ++c) {
        int sum = 0;
        for (int v = 0; v < rows; ++v)
          for (int u = 0; u < by; ++u) sum += picture.at(x * by + u, y * by + v)[c];
        out.pixels.push_back(static_cast<std::uint8_t>((sum + by * rows / 2) / (by * rows)));
      }
    }
  }
  return out;
}

}  // namespace gnomon::apps::study
