// The inspector's pages: one file each, with the rasterizer inside (WebAssembly), that opens from
// disk and asks no network for anything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon::apps::inspector {

/// A frame on the page.
struct PageFrame {
  std::string name;
  /// As raster::encode_frame writes it.
  std::vector<std::uint8_t> bytes;
};

/// The page that shows a frame, or two side by side.
/// Throws ar::InputError where the program was built without the module.
std::string inspect_page(const std::string& title, const std::vector<PageFrame>& frames);

/// The page to play with. Throws as above.
std::string lab_page();

}  // namespace gnomon::apps::inspector
