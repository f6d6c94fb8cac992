#include "sim/calibrate/frames_folder.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/base/checked_json.h"
#include "sim/image/io/grey16.h"

namespace hydroprint::calibrate {
namespace {

constexpr int kLeastSide_px = 16, kMostSide_px = 4096;
constexpr double kWidestView_rad = 3;

/// The content of frames.json.
struct Listing {
  int width = 0, height = 0;
  double horizontal_fov_rad = 0, vertical_fov_rad = 0;
  std::vector<std::string> files;
  std::vector<double> times_s;
};

bool is_plain(const std::string& name) {
  return !name.empty() && name != ".." && std::filesystem::path(name).filename() == name;
}

Result<Listing> read_listing(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(path));
  const auto wrong = [&](const std::string& what) {
    return fail(Code::kInvalidArgument,
                path.string() + ": " + what + ". Use a folder written by hydroprint-capture");
  };
  Listing out;
  try {
    out.width = json.at("width").get<int>();
    out.height = json.at("height").get<int>();
    out.horizontal_fov_rad = json.at("horizontal_fov_rad").get<double>();
    out.vertical_fov_rad = json.at("vertical_fov_rad").get<double>();
    for (const auto& frame : json.at("frames")) {
      out.files.push_back(frame.at("file").get<std::string>());
      out.times_s.push_back(frame.value("time_s", 0.0));
    }
  } catch (const nlohmann::json::exception&) {
    return wrong("does not list frames with their size and fields of view");
  }
  const auto is_side = [](int px) { return px >= kLeastSide_px && px <= kMostSide_px; };
  const auto is_view = [](double rad) { return rad > 0 && rad < kWidestView_rad; };
  if (!is_side(out.width) || !is_side(out.height)) return wrong("image size out of range");
  if (!is_view(out.horizontal_fov_rad) || !is_view(out.vertical_fov_rad))
    return wrong("field of view out of range");
  if (out.files.empty()) return wrong("lists no frames");
  if (!std::all_of(out.files.begin(), out.files.end(), is_plain))
    return wrong("lists a frame in another folder");
  return out;
}

scan::Lens lens_of(const Listing& listing) {
  scan::Lens out;
  out.width_px = listing.width;
  out.height_px = listing.height;
  out.fx_px = listing.width / 2.0 / std::tan(listing.horizontal_fov_rad / 2);
  out.fy_px = listing.height / 2.0 / std::tan(listing.vertical_fov_rad / 2);
  out.cx_px = (listing.width - 1) / 2.0;
  out.cy_px = (listing.height - 1) / 2.0;
  return out;
}

}  // namespace

Result<Frames> read_frames(const std::filesystem::path& folder, const Context& context,
                           std::size_t most) {
  HP_ASSIGN_OR_RETURN(const Listing listing, read_listing(folder / "frames.json"));
  Frames out{{}, listing.times_s, lens_of(listing)};
  out.frames.resize(std::min(most, listing.files.size()));
  out.times_s.resize(out.frames.size());
  const auto read_one = [&](std::size_t i) -> Status {
    const std::filesystem::path path = folder / listing.files[i];
    HP_ASSIGN_OR_RETURN(const image::Grey16Image grey, image::read_grey16(path, context));
    if (grey.width != listing.width || grey.height != listing.height)
      return fail(Code::kDataLoss, path.string() +
                                       ": the image size differs from the size in frames.json. "
                                       "Capture the frames again");
    out.frames[i] = {grey.width, grey.height,
                     std::vector<float>(grey.grey.begin(), grey.grey.end())};
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "reading", out.frames.size(), read_one));
  return out;
}

}  // namespace hydroprint::calibrate
