#include "tests/sim/print/raster_files.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tests/support/process.h"

namespace hydroprint::print {
namespace {

void run(const std::vector<std::string>& command) {
  const testing::Ended ended = testing::run(command);
  if (ended.status != 0) throw std::runtime_error(command[0] + ": " + ended.err);
}

/// Reads the header of a PAM file up to the pixels. Comments are not supported.
Raster read_pam(std::istream& in) {
  Raster out;
  std::string word;
  while (in >> word && word != "ENDHDR") {
    if (word == "WIDTH") in >> out.width;
    if (word == "HEIGHT") in >> out.height;
    if (word == "DEPTH") in >> out.channels;
  }
  return out;
}

}  // namespace

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": missing");
  return {std::istreambuf_iterator<char>(file), {}};
}

Raster read_netpbm(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string magic;
  in >> magic;
  Raster out;
  if (magic == "P7") {
    out = read_pam(in);
  } else if (magic == "P5" || magic == "P6") {
    int most = 0;
    in >> out.width >> out.height >> most;
    out.channels = magic == "P5" ? 1 : 3;
  } else {
    throw std::runtime_error(path.string() + ": not a netpbm file");
  }
  in.get();
  out.samples.resize(static_cast<std::size_t>(out.width) * out.height * out.channels);
  in.read(reinterpret_cast<char*>(out.samples.data()), static_cast<long>(out.samples.size()));
  if (!in) throw std::runtime_error(path.string() + ": truncated");
  return out;
}

Raster drawn_by_poppler(const std::filesystem::path& pdf, int dpi, int page) {
  const testing::TemporaryFolder folder;
  const std::string number = std::to_string(page);
  run({"/usr/bin/pdftoppm", "-r", std::to_string(dpi), "-gray", "-singlefile", "-f", number, "-l",
       number, pdf, folder.path() / "page"});
  return read_netpbm(folder.path() / "page.pgm");
}

Raster inks_by_mupdf(const std::filesystem::path& file, int dpi, int page) {
  const testing::TemporaryFolder folder;
  const std::string out = folder.path() / "page.pam";
  run({"/usr/bin/mutool", "draw", "-q", "-N", "-A", "0", "-c", "cmyk", "-F", "pam", "-r",
       std::to_string(dpi), "-o", out, file, std::to_string(page)});
  return read_netpbm(out);
}

std::string traced_by_mupdf(const std::filesystem::path& pdf) {
  const testing::TemporaryFolder folder;
  const std::string out = folder.path() / "trace.xml";
  run({"/usr/bin/mutool", "draw", "-q", "-F", "trace", "-o", out, pdf});
  return bytes_of(out);
}

std::map<int, double> tiff_tags(const std::filesystem::path& path) {
  const std::string file = bytes_of(path);
  if (!file.starts_with("II*")) throw std::runtime_error("not a little-endian TIFF file");
  const auto u16 = [&](std::size_t at) {
    std::uint16_t value = 0;
    std::memcpy(&value, &file.at(at), 2);
    return value;
  };
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, &file.at(at), 4);
    return value;
  };
  std::map<int, double> out;
  const std::size_t directory = u32(4);
  for (int i = 0; i < u16(directory); ++i) {
    const std::size_t entry = directory + 2 + 12U * static_cast<std::size_t>(i);
    const int type = u16(entry + 2);
    const std::uint32_t value = u32(entry + 8);
    if (type == 3) out[u16(entry)] = u16(entry + 8);
    if (type == 4 || type == 7) out[u16(entry)] = type == 4 ? value : u32(entry + 4);
    if (type == 5) out[u16(entry)] = static_cast<double>(u32(value)) / u32(value + 4);
  }
  return out;
}

PngResolution png_resolution(const std::filesystem::path& path) {
  const std::string file = bytes_of(path);
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(file.at(at + i));
    return value;
  };
  PngResolution out;
  for (std::size_t at = 8; at + 8 <= file.size(); at += 12 + u32(at)) {
    if (file.substr(at + 4, 4) != "pHYs") continue;
    out.per_metre_x = u32(at + 8);
    out.per_metre_y = u32(at + 12);
  }
  return out;
}

}  // namespace hydroprint::print
