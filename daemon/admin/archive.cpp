#include "daemon/admin/archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "sim/base/sha256.h"
#include "sim/base/utf8.h"

namespace hydroprint::admin {
namespace {

constexpr std::size_t kPiece = 1 << 20;

struct CloseEntry {
  void operator()(archive_entry* entry) const { archive_entry_free(entry); }
};
using Entry = std::unique_ptr<archive_entry, CloseEntry>;

// errno distinguishes a full disk from other errors.
tl::unexpected<Error> writing_failed(const std::filesystem::path& path, archive* out) {
  if (archive_errno(out) != ENOSPC && archive_errno(out) != EDQUOT) {
    const char* const words = archive_error_string(out);
    return fail(Code::kInternal,
                fmt::format("{}: cannot be written: {}", path.string(),
                            one_line(words == nullptr ? "no reason given" : words)));
  }
  errno = archive_errno(out);
  return daemon::system_failure(path, "cannot be written");
}

}  // namespace

struct ArchiveWriter::Impl {
  ~Impl() {
    if (out != nullptr) archive_write_free(out);
    file.reset();
    if (!is_finished) daemon::discard(part);
  }
  Status begin(const std::string& name, std::int64_t size) {
    const Entry entry(archive_entry_new());
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), size);
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0600);
    if (archive_write_header(out, entry.get()) != ARCHIVE_OK) return writing_failed(part, out);
    return {};
  }
  Status write(const char* bytes, std::size_t size) {
    while (size > 0) {
      const auto count = archive_write_data(out, bytes, size);
      if (count <= 0) return writing_failed(part, out);
      bytes += count;
      size -= static_cast<std::size_t>(count);
    }
    return {};
  }

  std::filesystem::path path, part;
  daemon::UniqueFd file;
  archive* out = nullptr;
  bool is_finished = false;
};

ArchiveWriter::ArchiveWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ArchiveWriter::~ArchiveWriter() = default;

Result<std::unique_ptr<ArchiveWriter>> ArchiveWriter::create(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) {
    return fail(Code::kAlreadyExists, path.string() + ": already exists; name another file");
  }
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->part = path.string() + ".part";
  HP_ASSIGN_OR_RETURN(impl->file, daemon::open_file(impl->part, O_WRONLY | O_CREAT | O_TRUNC));
  impl->out = archive_write_new();
  if (impl->out == nullptr) return fail(Code::kResourceExhausted, "out of memory");
  // Stores names as bytes, regardless of the locale.
  if (archive_write_set_format_pax_restricted(impl->out) != ARCHIVE_OK ||
      archive_write_set_format_option(impl->out, "pax", "hdrcharset", "BINARY") != ARCHIVE_OK ||
      archive_write_add_filter_none(impl->out) != ARCHIVE_OK ||
      archive_write_open_fd(impl->out, impl->file.get()) != ARCHIVE_OK) {
    return writing_failed(impl->part, impl->out);
  }
  return std::unique_ptr<ArchiveWriter>(new ArchiveWriter(std::move(impl)));
}

Result<std::string> ArchiveWriter::add(const std::string& name, const daemon::UniqueFd& file,
                                       std::int64_t size,
                                       const std::function<void(std::int64_t)>& taken) {
  HP_RETURN_IF_ERROR(impl_->begin(name, size));
  std::vector<char> buffer(kPiece);
  Sha256 hash;
  std::int64_t left = size;
  while (left > 0) {
    const auto wanted = static_cast<std::size_t>(std::min<std::int64_t>(left, kPiece));
    const ssize_t count = ::read(file.get(), buffer.data(), wanted);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    HP_RETURN_IF_ERROR(impl_->write(buffer.data(), static_cast<std::size_t>(count)));
    hash.add({buffer.data(), static_cast<std::size_t>(count)});
    left -= count;
    taken(count);
  }
  if (left == 0) return hash.finish();
  if (archive_write_finish_entry(impl_->out) != ARCHIVE_OK) {
    return writing_failed(impl_->part, impl_->out);
  }
  return fail(Code::kDataLoss, name + ": shorter than expected, or cannot be read");
}

Status ArchiveWriter::add(const std::string& name, std::string_view content) {
  HP_RETURN_IF_ERROR(impl_->begin(name, static_cast<std::int64_t>(content.size())));
  return impl_->write(content.data(), content.size());
}

Status ArchiveWriter::finish() {
  if (archive_write_close(impl_->out) != ARCHIVE_OK) return writing_failed(impl_->part, impl_->out);
  if (::fsync(impl_->file.get()) != 0) {
    return daemon::system_failure(impl_->part, "cannot be flushed to disk");
  }
  HP_RETURN_IF_ERROR(daemon::publish(impl_->part, impl_->path));
  impl_->is_finished = true;
  return {};
}

struct ArchiveReader::Impl {
  ~Impl() {
    if (in != nullptr) archive_read_free(in);
  }
  [[nodiscard]] tl::unexpected<Error> failed() const {
    const char* const words = archive_error_string(in);
    return fail(Code::kInvalidArgument,
                fmt::format("{}: not a complete hydroprint archive: {}", path.string(),
                            one_line(words == nullptr ? "no reason given" : words)));
  }

  std::filesystem::path path;
  daemon::UniqueFd file;
  archive* in = nullptr;
};

ArchiveReader::ArchiveReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ArchiveReader::~ArchiveReader() = default;

Result<std::unique_ptr<ArchiveReader>> ArchiveReader::open(const std::filesystem::path& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->file = daemon::UniqueFd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!impl->file.valid()) {
    const int reason = errno;
    return fail(reason == ENOENT ? Code::kNotFound : Code::kPermissionDenied,
                fmt::format("{}: cannot be read: {}", path.string(),
                            std::generic_category().message(reason)));
  }
  impl->in = archive_read_new();
  if (impl->in == nullptr) return fail(Code::kResourceExhausted, "out of memory");
  // Supports only uncompressed tar, so that nothing expands when read and no other parsers are
  // exposed.
  if (archive_read_support_format_tar(impl->in) != ARCHIVE_OK ||
      archive_read_open_fd(impl->in, impl->file.get(), kPiece) != ARCHIVE_OK) {
    return impl->failed();
  }
  return std::unique_ptr<ArchiveReader>(new ArchiveReader(std::move(impl)));
}

Result<std::optional<ArchiveEntry>> ArchiveReader::next() {
  archive_entry* entry = nullptr;
  const int code = archive_read_next_header(impl_->in, &entry);
  if (code == ARCHIVE_EOF) return std::optional<ArchiveEntry>();
  if (code != ARCHIVE_OK) return impl_->failed();
  const char* const name = archive_entry_pathname(entry);
  const bool is_plain = archive_entry_filetype(entry) == AE_IFREG &&
                        archive_entry_hardlink(entry) == nullptr &&
                        archive_entry_symlink(entry) == nullptr;
  return std::optional(
      ArchiveEntry{name == nullptr ? "" : name, archive_entry_size(entry), is_plain});
}

Status ArchiveReader::read(const std::function<Status(std::string_view)>& piece) {
  std::vector<char> buffer(kPiece);
  for (;;) {
    const auto count = archive_read_data(impl_->in, buffer.data(), buffer.size());
    if (count < 0) return impl_->failed();
    if (count == 0) return {};
    HP_RETURN_IF_ERROR(piece({buffer.data(), static_cast<std::size_t>(count)}));
  }
}

}  // namespace hydroprint::admin
