#include "server/http/submit_words.h"

#include "server/http/asset_intake.h"
#include "server/http/body.h"
#include "server/http/guard/guarded_server.h"
#include "server/http/multipart.h"
#include "server/http/negotiation.h"
#include "server/http/printable.h"

#include <algorithm>
#include <cctype>
#include <optional>

namespace server {

namespace {

using Read = std::variant<SubmitWords, api::ProblemDetails>;

constexpr const char* kScenePart = "scene";
constexpr std::size_t kMaxParts = 1000;
constexpr std::size_t kMaxNameBytes = 255;
constexpr const char* kCurlHint =
    "send JSON (curl --json @scene.json URL/v1/jobs) or a form with the files that the scene names "
    "(curl -F scene=@scene.json -F bunny.obj=@bunny.obj URL/v1/jobs)";

enum class BodyKind : std::uint8_t { json, form, multipart, other };

BodyKind kind_of(std::string type)
{
    type = type.substr(0, type.find(';'));
    type.erase(type.find_last_not_of(" \t") + 1);
    std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    if (type.empty() || type == "application/json" ||
        (type.rfind("application/", 0) == 0 && type.ends_with("+json")))
        return BodyKind::json;
    if (type == "application/x-www-form-urlencoded") return BodyKind::form;
    return type == "multipart/form-data" ? BodyKind::multipart : BodyKind::other;
}

// A name is a key of `files` and never a path; yet one that climbs out of its folder means no good.
const char* fault_of_name(const std::string& name)
{
    if (name.empty() || name.size() > kMaxNameBytes) return "a part's name has 1 to 255 bytes";
    if (std::any_of(name.begin(), name.end(), [](char c) {
            return static_cast<unsigned char>(c) < ' ' || c == 0x7f || c == '\\';
        }))
        return "a part's name holds no control character and no backslash";
    const std::string framed = "/" + name + "/";
    if (framed.find("/../") != std::string::npos || framed.find("/./") != std::string::npos ||
        framed.find("//") != std::string::npos)
        return "a part's name is the file's name in the scene: no leading slash, no empty, . or .. between "
               "slashes";
    return nullptr;
}

// Takes the parts of a form: `scene` into memory, the others into the asset store.
class FormTaker final : public PartTaker {
public:
    FormTaker(Store& store, BlobStore& blobs, const renderer::Limits& limits)
        : store_(store), blobs_(blobs), limits_(limits)
    {
    }

    bool begin_part(const std::string& name) override
    {
        name_ = name;
        if (const char* fault = fault_of_name(name)) return refuse(named(422, "invalid_name", fault));
        if (name == kScenePart ? scene_.has_value() : files_.contains(name))
            return refuse(named(422, "duplicate_name", "two parts have this name: each names one file"));
        if (files_.size() >= kMaxParts)
            return refuse(problem(
                413, "too_many_parts", "one form carries at most " + std::to_string(kMaxParts) + " files"));
        if (name == kScenePart)
            scene_.emplace();
        else
            file_.emplace(store_, blobs_, limits_, false);
        return true;
    }

    bool take(std::string_view bytes) override
    {
        // Together too: or one request of many files would fill the disk before the first is asked about.
        files_bytes_ += file_ ? bytes.size() : 0;
        if (files_bytes_ > limits_.asset_bytes || (file_ && !file_->append(bytes)))
            return refuse(
                over_limit("the files of one form together: PUT /v1/assets/sha256:... takes each alone; this",
                           "asset_bytes",
                           limits_));
        if (file_) return true;
        if (scene_->size() + bytes.size() > limits_.json_bytes)
            return refuse(over_limit("the part scene", "json_bytes", limits_));
        *scene_ += bytes;
        return true;
    }

    bool end_part() override
    {
        if (!file_) return true;
        auto stored = file_->commit();
        file_.reset();
        if (auto* refusal = std::get_if<api::ProblemDetails>(&stored)) return refuse(std::move(*refusal));
        files_[name_] = std::get<StoredAsset>(stored).digest;
        return true;
    }

    void make_files_durable()
    {
        std::vector<std::string> digests;
        for (const auto& [name, digest] : files_)
            digests.push_back(digest);
        blobs_.make_durable(BlobStore::Kind::asset, digests);
    }

    std::optional<api::ProblemDetails>& refusal() { return refusal_; }
    std::optional<std::string>& scene() { return scene_; }
    std::map<std::string, std::string>& files() { return files_; }

private:
    api::ProblemDetails named(int status, const char* code, const std::string& detail) const
    {
        return api::problem_from_faults(
            status, "invalid_form", {{"", code, std::string("\"") + printable(name_) + "\": " + detail}});
    }
    bool refuse(api::ProblemDetails details)
    {
        refusal_ = std::move(details);
        return false;
    }

    Store& store_;
    BlobStore& blobs_;
    const renderer::Limits& limits_;
    std::string name_;
    std::optional<std::string> scene_;
    std::optional<AssetIntake> file_;
    std::uint64_t files_bytes_ = 0;
    std::map<std::string, std::string> files_;
    std::optional<api::ProblemDetails> refusal_;
};

Read read_multipart(Exchange& exchange, FormTaker&& taker)
{
    const std::string boundary = multipart_boundary(exchange.header(kBodyType));
    if (boundary.empty())
        return problem(400, "bad_request", "Content-Type: multipart/form-data needs its boundary");
    MultipartReader reader(boundary, taker);
    auto failure = read_body(exchange, [&](std::string_view bytes) { return reader.feed(bytes); });
    if (failure) return *std::move(failure);
    if (taker.refusal()) return *std::move(taker.refusal());
    if (!reader.fault().empty()) return problem(400, "bad_request", reader.fault());
    if (!reader.finished()) return problem(400, "bad_request", "the form ends before its closing boundary");
    if (!taker.scene())
        return problem(
            422,
            "missing_scene",
            "the form has no part named scene: curl -F scene=@scene.json; the other parts are its files");
    SubmitWords words;
    words.body = *std::move(taker.scene());
    taker.make_files_durable();
    words.part_digests = std::move(taker.files());
    return words;
}

Read read_json(Exchange& exchange, BodyKind kind, const renderer::Limits& limits)
{
    SubmitWords words;
    bool over = false;
    auto failure = read_body(exchange, [&](std::string_view bytes) {
        over = words.body.size() + bytes.size() > limits.json_bytes;
        if (!over) words.body += bytes;
        return !over;
    });
    if (failure) return *std::move(failure);
    if (over) return over_limit("the JSON body", "json_bytes", limits);
    const std::size_t start = words.body.find_first_not_of(" \t\r\n");
    if (start == std::string::npos)
        return problem(400, "empty_body", std::string("the body is empty: ") + kCurlHint);
    // curl -d @scene.json calls JSON a form; a form that is one begins with a name.
    if (kind == BodyKind::form && words.body[start] != '{')
        return problem(
            415, "unsupported_media_type", std::string("a form of this type is not taken: ") + kCurlHint);
    return words;
}

std::optional<api::ProblemDetails> add_headers(const Exchange& exchange, SubmitWords& words)
{
    words.no_cache = wants_fresh(exchange.header("Cache-Control"));
    if (!exchange.has_header("Idempotency-Key")) return std::nullopt;
    words.idempotency_key = exchange.header("Idempotency-Key");
    const bool good = !words.idempotency_key.empty() && words.idempotency_key.size() <= kMaxNameBytes &&
                      std::all_of(words.idempotency_key.begin(), words.idempotency_key.end(), [](char c) {
                          return c > ' ' && c <= '~';
                      });
    if (good) return std::nullopt;
    return problem(400, "bad_request", "Idempotency-Key is 1 to 255 visible ASCII characters");
}

} // namespace

Read read_submit_words(Exchange& exchange, Store& store, BlobStore& blobs, const renderer::Limits& limits)
{
    const BodyKind kind = kind_of(exchange.header(kBodyType));
    SubmitWords head;
    if (auto refusal = add_headers(exchange, head)) return *std::move(refusal);
    if (kind == BodyKind::other)
        return problem(415,
                       "unsupported_media_type",
                       "the body's type " + printable(exchange.header(kBodyType)) +
                           " is not taken: " + kCurlHint);
    // Of a form only the files are counted, as they come.
    if (auto refusal = kind == BodyKind::multipart
                           ? refuse_without_length(exchange, "the form")
                           : refuse_by_head(exchange, "the JSON body", "json_bytes", limits))
        return *std::move(refusal);
    Read read = kind == BodyKind::multipart ? read_multipart(exchange, FormTaker(store, blobs, limits))
                                            : read_json(exchange, kind, limits);
    if (auto* words = std::get_if<SubmitWords>(&read)) {
        words->idempotency_key = head.idempotency_key;
        words->no_cache = head.no_cache;
    }
    return read;
}

} // namespace server
