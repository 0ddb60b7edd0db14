// heliograph-import NAME TRIANGLES TEXTURE_PIXELS MEMORY_BYTES OUTPUT_BYTES CPU_S: imports one mesh or picture
// for heliographd, which starts it.
//
// Descriptors  2 log, 3 the file, 4 the output in the flat form, 5 the file desk. It opens nothing else by its
//              own will; the kernel would let it (see lockdown.h).
// Exit codes   0: the output holds a mesh, a picture or a failure · 2: wrong arguments · 3: it cannot lock itself down ·
// 4: it cannot write.
#include "renderer/io/import_image.h"
#include "renderer/io/import_mesh.h"
#include "server/import/file_desk.h"
#include "server/import/flat_mesh.h"
#include "server/import/lockdown.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

constexpr int kFile = 3, kOutput = 4, kDesk = 5;

// A whole file in memory, as long as this lives; empty if it has no bytes or cannot be mapped.
class MappedFile {
public:
    explicit MappedFile(int fd)
    {
        struct stat state {};
        if (::fstat(fd, &state) != 0 || state.st_size <= 0) return;
        void* data = ::mmap(nullptr, static_cast<std::size_t>(state.st_size), PROT_READ, MAP_PRIVATE, fd, 0);
        if (data == MAP_FAILED) throw std::bad_alloc();
        bytes_ = {static_cast<const std::byte*>(data), static_cast<std::size_t>(state.st_size)};
    }
    MappedFile(const MappedFile&) = delete; // never unmapped: the process ends with the import
    MappedFile& operator=(const MappedFile&) = delete;
    std::span<const std::byte> bytes() const { return bytes_; }

private:
    std::span<const std::byte> bytes_;
};

// Companion files by name, each asked for once.
class Companions {
public:
    std::optional<std::span<const std::byte>> open(std::string_view name)
    {
        const auto known = files_.find(name);
        if (known != files_.end()) return known->second;
        std::optional<std::span<const std::byte>> bytes;
        if (const server::FileDescriptor file = server::ask_for_file(kDesk, name))
            bytes = MappedFile(file.get()).bytes();
        files_.emplace(name, bytes);
        return bytes;
    }

private:
    std::map<std::string, std::optional<std::span<const std::byte>>, std::less<>> files_;
};

server::ImportFailure failure_of(renderer::ImportFault& fault)
{
    return {std::move(fault.code), std::move(fault.detail)};
}

server::ImportOutcome
import_picture(std::string_view name, const MappedFile& file, const renderer::Limits& limits)
{
    renderer::ImageResult result = renderer::import_image(name, file.bytes(), limits);
    if (auto* fault = std::get_if<renderer::ImportFault>(&result)) return failure_of(*fault);
    auto& imported = std::get<renderer::ImportedImage>(result);
    return within_flat_bounds(server::ImportedPicture{std::move(imported.image), std::move(imported.format)},
                              limits);
}

server::ImportOutcome import(std::string_view name, const renderer::Limits& limits)
try {
    const MappedFile file(kFile);
    // Who wants a mesh is told what the file is, if it is a picture.
    if (name.starts_with(server::kPictureWord) || renderer::looks_like_image(name, file.bytes()))
        return import_picture(name, file, limits);
    Companions companions;
    renderer::ImportResult result = renderer::import_mesh(
        name, file.bytes(), [&](std::string_view companion) { return companions.open(companion); }, limits);
    if (auto* fault = std::get_if<renderer::ImportFault>(&result)) {
        if (fault->code != "unknown_format") return failure_of(*fault);
        server::ImportOutcome as_picture = import_picture(name, file, limits);
        const auto* failure = std::get_if<server::ImportFailure>(&as_picture);
        return failure != nullptr && failure->code == fault->code ? failure_of(*fault)
                                                                  : std::move(as_picture);
    }
    auto& imported = std::get<renderer::ImportedMesh>(result);
    return within_flat_bounds(server::ImportedAsset{std::move(imported.mesh),
                                                    std::move(imported.format),
                                                    std::move(imported.notes)},
                              limits);
} catch (const std::bad_alloc&) {
    return server::ImportFailure{"import_out_of_memory", "not enough memory"};
}

bool write_all(std::span<const std::byte> bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(kOutput, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

bool parse(const char* word, std::uint64_t& value)
{
    const char* const end = word + std::strlen(word);
    const auto parsed = std::from_chars(word, end, value);
    return parsed.ec == std::errc() && parsed.ptr == end;
}

// Without the C library's clean-up: nothing of ours is left to do, and a crash there would be told as the
// file's.
[[noreturn]] void leave(int code, const char* why)
{
    if (code) std::fprintf(stderr, "heliograph-import: %s\n", why);
    std::fflush(stderr);
    ::_exit(code);
}

} // namespace

// What throws here ends this process alone, which the service tells as a crash.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int count, char** words)
{
    renderer::Limits limits;
    std::uint64_t cpu_s = 0;
    if (count != 7 || !parse(words[2], limits.triangles) || !parse(words[3], limits.texture_pixels) ||
        !parse(words[4], limits.import_memory_bytes) || !parse(words[5], limits.import_output_bytes) ||
        !parse(words[6], cpu_s))
        leave(2, "is started by heliographd, not by hand");
    std::string why_not;
    if (!server::lock_down({limits.import_memory_bytes, limits.import_output_bytes, cpu_s}, why_not))
        leave(3, why_not.c_str());
    const server::ImportOutcome outcome = import(words[1], limits);
    bool written = true;
    server::write_flat(outcome,
                       [&](std::span<const std::byte> bytes) { written = written && write_all(bytes); });
    leave(written ? 0 : 4, "the output cannot be written");
}
