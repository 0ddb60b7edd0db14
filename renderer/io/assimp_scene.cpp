#include "renderer/io/assimp_scene.h"

#include "renderer/io/flatten_scene.h"
#include "renderer/io/gltf_buffers.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <array>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace renderer {

namespace {

// What assimp takes for a file system: the file at hand and its companions, by name.
class GivenFiles : public Assimp::IOSystem {
public:
    GivenFiles(std::string name,
               std::span<const std::byte> bytes,
               CompanionFiles& files,
               std::string& missing)
        : name_(std::move(name)), bytes_(bytes), files_(files), missing_(missing)
    {
    }
    bool Exists(const char* file) const override
    {
        return file == name_ || open_uri(files_, file).has_value();
    }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (std::string_view(mode).find('w') != std::string_view::npos) return nullptr;
        if (file == name_) return stream(bytes_);
        if (const auto bytes = open_uri(files_, file)) return stream(*bytes);
        missing_ = file;
        return nullptr;
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    static Assimp::IOStream* stream(std::span<const std::byte> bytes)
    {
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    std::string name_;
    std::span<const std::byte> bytes_;
    CompanionFiles& files_;
    std::string& missing_;
};

void keep_only(Assimp::Importer& importer, std::string_view wanted)
{
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc* description = importer.GetImporterInfo(i);
        if (description && std::string_view(description->mName).starts_with(wanted)) continue;
        Assimp::BaseImporter* reader = importer.GetImporter(i);
        importer.UnregisterLoader(reader);
        delete reader;
    }
}

class Listener : public Assimp::Logger {
public:
    explicit Listener(std::vector<std::string>& heard) : heard_(heard) {}
    bool attachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }
    bool detachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }

protected:
    void OnDebug(const char* /*message*/) override {}
    void OnVerboseDebug(const char* /*message*/) override {}
    void OnInfo(const char* /*message*/) override {}
    void OnWarn(const char* /*message*/) override {}
    void OnError(const char* message) override
    {
        // Said of every FBX without materials, where nothing is lost.
        if (std::string_view(message).find("setting default material") != std::string_view::npos) return;
        if (heard_.size() < kMostNotes / 2) heard_.emplace_back(message);
    }

private:
    std::vector<std::string>& heard_;
};

// Takes assimp's log while it lives, and keeps the first errors.
class Complaints {
public:
    Complaints() : lock_(one_at_a_time()) { Assimp::DefaultLogger::set(new Listener(heard_)); }
    ~Complaints() { Assimp::DefaultLogger::set(nullptr); } // which deletes the listener
    Complaints(const Complaints&) = delete;
    Complaints& operator=(const Complaints&) = delete;
    const std::vector<std::string>& heard() const { return heard_; }

private:
    static std::mutex& one_at_a_time()
    {
        static std::mutex mutex;
        return mutex;
    }
    const std::lock_guard<std::mutex> lock_;
    std::vector<std::string> heard_;
};

// What assimp's words mean, as far as they tell more than that it gave up.
std::string code_of(const std::string& words)
{
    const std::string said = lower_case(words);
    constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kMeanings{
        {{"index out of range", "index_out_of_range"},
         {"invalid data index", "index_out_of_range"},
         {"out of range", "index_out_of_range"},
         {"unexpected end", "truncated"},
         {"premature end", "truncated"},
         {"expected more values", "truncated"},
         {"is truncated", "truncated"}}};
    for (const auto& [part, code] : kMeanings)
        if (said.find(part) != std::string::npos) return std::string(code);
    return "malformed";
}

ImportFault fault_of(const AssimpReader& reader, const Assimp::Importer& importer, const std::string& missing)
{
    try {
        if (importer.GetException()) std::rethrow_exception(importer.GetException());
    } catch (const std::bad_alloc&) {
        throw;      // memory is not the file's fault; the caller tells it
    } catch (...) { // anything else is what GetErrorString says
    }
    if (!missing.empty())
        return {"missing_file",
                "the " + reader.title + " names " + in_quotes(missing) +
                    ", which did not come with it: a job names it in its files"};
    const std::string words = importer.GetErrorString();
    return {code_of(words), "the " + reader.title + " cannot be read: " + clean_utf8(words)};
}

} // namespace

ImportResult read_with_assimp(const AssimpReader& reader,
                              std::span<const std::byte> bytes,
                              CompanionFiles& files,
                              const Limits& limits)
{
    const Complaints complaints;
    std::string missing;
    Assimp::Importer importer;
    keep_only(importer, reader.importer);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES,
                             true); // else bones are drawn where a file has no mesh
    const std::string name = "mesh." + reader.format;
    importer.SetIOHandler(new GivenFiles(name, bytes, files, missing)); // the importer owns it
    const aiScene* scene = importer.ReadFile(name, 0);
    if (!scene || !missing.empty()) return fault_of(reader, importer, missing);
    ImportedMesh result;
    result.format = reader.format;
    for (const std::string& words : complaints.heard()) {
        const std::string told = "the " + reader.title + " cannot be read whole: " + clean_utf8(words);
        if (code_of(words) != "malformed") return ImportFault{code_of(words), told};
        result.notes.push_back(told);
    }
    if (!scene->mRootNode) return ImportFault{"no_triangles", "the " + reader.title + " has no nodes"};
    if (auto bad = flatten_scene(*scene, files, limits, result)) return std::move(*bad);
    return result;
}

} // namespace renderer
