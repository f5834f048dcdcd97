// Recovers a camera's response from exposures of one scene and prints it as the JSON that
// ar::read_response reads. Method: Debevec and Malik 1997, by OpenCV's photo module. Usage:
// recover_response FOLDER, where FOLDER/exposures.json lists
// {"exposures": [{"file": NAME, "time_s": SECONDS}, ...]}.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/photo.hpp>

namespace {

constexpr int kSamples = 400;
/// Weight of smoothness against the pixels.
constexpr float kSmoothness = 50.0f;

void run(const std::filesystem::path& folder) {
  const auto list = nlohmann::json::parse(std::ifstream(folder / "exposures.json"));
  std::vector<cv::Mat> pictures;
  std::vector<float> times_s;
  for (const auto& exposure : list.at("exposures")) {
    pictures.push_back(cv::imread((folder / exposure.at("file").get<std::string>()).string()));
    if (pictures.back().empty()) throw std::runtime_error("a picture cannot be read");
    times_s.push_back(exposure.at("time_s").get<float>());
  }
  cv::Mat curve;
  cv::createCalibrateDebevec(kSamples, kSmoothness)->process(pictures, curve, times_s);
  nlohmann::json table = nlohmann::json::array();
  // OpenCV's channels are b, g, r. Noise at the ends may fall; light never does.
  cv::Vec3f highest(0, 0, 0);
  for (int v = 0; v < 256; ++v) {
    for (int c = 0; c < 3; ++c) highest[c] = std::max(highest[c], curve.at<cv::Vec3f>(v)[c]);
    table.push_back({highest[2], highest[1], highest[0]});
  }
  std::cout << nlohmann::json{{"note", "recovered from " + std::to_string(pictures.size()) +
                                           " exposures (Debevec and Malik 1997)"},
                              {"inverse_table_rgb", table}}
                   .dump(1)
            << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: recover_response FOLDER");
    run(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "recover_response: " << error.what() << '\n';
    return 1;
  }
}
