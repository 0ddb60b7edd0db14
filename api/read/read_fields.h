// ReadFields: the visitor that fills a struct of the job from a JSON object and collects every fault of it.
//
// A member that is absent leaves its default; one that is faulty leaves it too and is told. Members that no
// walk asked for are faults of finish().
#pragma once

#include "api/fields/ranges.h"
#include "api/job_request.h"
#include "api/json/json.h"
#include "api/read/fault_list.h"
#include "api/words/word_table.h"
#include "renderer/description/atmosphere.h"
#include "renderer/description/layers.h"
#include "renderer/description/texture.h"

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

namespace api {

// What one reading shares between its objects.
struct ReadState {
    const ReadContext& context;
    JobRequest& job; // files, meshes and images, as far as they are read
    FaultList faults{};
    std::unordered_map<std::string, std::uint32_t> materials{}; // name -> index
    std::unordered_map<std::string, std::uint32_t> meshes{};    // name -> index
    std::unordered_map<std::string, std::uint32_t> images{};    // name -> index
    std::vector<std::string> material_names{};
    bool materials_unreadable = false; // then no reference to one is a fault of its own
    bool files_unreadable = false;
};

class ReadFields {
public:
    // Faults if `node` is not an object, and then finds no member.
    ReadFields(const Json& node, std::string pointer, ReadState& state);
    void finish(); // unknown members

    bool number(const char* name, double& value, const Range& range, const char* doc);
    bool number(const char* name, std::optional<double>& value, const Range& range, const char* doc);
    void boolean(const char* name, bool& value, const char* doc);
    bool point(const char* name, renderer::Vec3d& value, const char* doc);
    bool direction(const char* name, renderer::Vec3d& value, const char* doc);
    void color(const char* name, renderer::Rgb& value, const Range& range, const char* doc);
    void color(const char* name, std::optional<renderer::Rgb>& value, const Range& range, const char* doc);
    // Either the value or an object that says which picture gives it.
    void textured_color(const char* name, renderer::TexturedColor& value, const Range& range, const char* doc)
    {
        if (!texture(name, value.texture)) color(name, value.value, range, doc);
    }
    void
    textured_number(const char* name, renderer::TexturedNumber& value, const Range& range, const char* doc)
    {
        if (!texture(name, value.texture)) number(name, value.value, range, doc);
    }

    template <std::integral T>
    void integer(const char* name, T& value, const WholeRange& range, const char*)
    {
        if (const std::optional<std::uint64_t> read = whole(name, range)) value = static_cast<T>(*read);
    }
    template <std::integral T>
    void integer(const char* name, std::optional<T>& value, const WholeRange& range, const char*)
    {
        if (const std::optional<std::uint64_t> read = whole(name, range)) value = static_cast<T>(*read);
    }
    template <typename E>
    void word(const char* name, E& value, const char*)
    {
        if (const Word* word = chosen(name, words_for<E>(), nullptr)) value = static_cast<E>(word->value);
    }
    template <typename E>
    void word(const char* name, std::optional<E>& value, const char*)
    {
        if (const Word* word = chosen(name, words_for<E>(), nullptr)) value = static_cast<E>(word->value);
    }
    template <typename... D>
    void extents(const char* name, const char*, D&... sizes)
    {
        if (const auto read = numbers<sizeof...(D)>(name, kSize)) {
            std::size_t i = 0;
            ((sizes = (*read)[i++]), ...);
        }
    }

    template <typename T>
    void object(const char* name, T& value, const char*)
    {
        if (const Json* node = find(name)) read_object(*node, at(name), value);
    }
    template <typename T>
    void object(const char* name, std::optional<T>& value, const char*)
    {
        if (const Json* node = find(name)) read_object(*node, at(name), value.emplace());
    }
    template <typename Walk>
    void group(const char* name, const char*, const Walk& walk)
    {
        const Json* node = find(name);
        if (!node) return;
        ReadFields child(*node, at(name), state_);
        walk(child);
        child.finish();
    }
    template <typename V>
    void kinds(const char* name, std::optional<V>& value, const char*)
    {
        if (const Json* node = find(name)) read_kind(*node, at(name), value.emplace());
    }
    // `limit`: name of the service's limit on the number of items; may be null.
    template <typename T>
    void list(const char* name, std::vector<T>& values, const char* limit, const char*)
    {
        const Json* items = array_of(name, limit);
        for (std::size_t i = 0; items && i < items->size(); ++i)
            read_item((*items)[i], at(name, i), values.emplace_back());
    }
    void table(const char* name, std::vector<renderer::NamedMaterial>& materials, const char*);

    // One number, which stands for all wavelengths, or an array of them.
    void coefficients(const char* name, std::vector<double>& values, const Range& range, const char* doc);
    // Starts from what the word stands for: visited before every other member.
    void preset(const char* name, renderer::AtmosphereDescription& atmosphere, const char* doc);

    void unbuilt(std::initializer_list<const char*> names, const char* remedy);
    void needs(std::initializer_list<const char*> names);
    void exclude(const char* a, const char* b, const char* remedy);

    // Members that are there only where `holds`; else each that is given is a fault with `remedy`.
    template <typename Walk>
    void only_when(bool holds, std::initializer_list<const char*> names, const char* remedy, const Walk& walk)
    {
        if (holds) return walk();
        for (const char* name : names)
            foreign(name, remedy);
    }

    void aim(renderer::CameraDescription& camera);
    void sun_angles(renderer::Vec3d& travels); // instead of `direction`: where it stands
    void geometry(renderer::Shape& shape);
    void image_of(std::uint32_t& image);
    void material_of(std::optional<std::uint32_t>& material);
    void metal_of(std::variant<renderer::Metal, renderer::ComplexIor>& ior);
    void placement(renderer::Affine3& world_from_object);
    void files(std::map<std::string, std::string>& files);
    void labels(std::map<std::string, std::string>& labels);
    void fail_on(std::vector<std::string>& words);
    void layers(renderer::LayerSet& layers);

    // The whole text is one thing whose `type` says what it is.
    template <typename V>
    static void read_alone(const Json& root, ReadState& state, V& value)
    {
        ReadFields child(root, "", state);
        if (child.alternative_named("type", value)) child.finish();
    }

private:
    template <typename T>
    void read_object(const Json& node, std::string pointer, T& value)
    {
        ReadFields child(node, std::move(pointer), state_);
        fields(child, value);
        child.finish();
    }
    // An object whose member `type` says which alternative it is.
    template <typename V>
    void read_kind(const Json& node, std::string pointer, V& value)
    {
        ReadFields child(node, std::move(pointer), state_);
        if (!child.alternative_named("type", value)) return;
        child.finish();
    }
    template <typename T>
    void read_item(const Json& node, std::string pointer, T& value)
    {
        read_object(node, std::move(pointer), value);
    }
    template <typename... Ts>
    void read_item(const Json& node, std::string pointer, std::variant<Ts...>& value)
    {
        read_kind(node, std::move(pointer), value);
    }
    // Fills `value` with the alternative that the member `name` says, and reads its members from this object.
    // False if there is no such alternative: then nothing else of the object is judged.
    template <typename V>
    bool alternative_named(const char* name, V& value)
    {
        if (!node_) return false;
        const Word* word = chosen(name, words_for<V>(), "it says what this is");
        if (!word) return false;
        emplace_index(value, static_cast<std::size_t>(word->value));
        std::visit([this](auto& alternative) { fields(*this, alternative); }, value);
        return true;
    }
    template <typename... Ts>
    static void emplace_index(std::variant<Ts...>& value, std::size_t index)
    {
        std::size_t i = 0;
        ((i++ == index ? static_cast<void>(value.template emplace<Ts>()) : static_cast<void>(0)), ...);
    }

    void foreign(const char* name, const char* remedy);
    [[nodiscard]] std::string at(std::string_view member) const;
    [[nodiscard]] std::string at(std::string_view member, std::size_t index) const;
    void fault(std::string pointer, const char* code, std::string detail);
    void wrong_type(std::string pointer, const char* expected, const Json& got);

    // The member, from now on known; nothing if absent.
    const Json* find(const char* name);
    const Json* array_of(const char* name, const char* limit);
    // The word of a string member; nothing if absent or faulty. `needed`: why it must be there; null: it need
    // not.
    const Word* chosen(const char* name, WordTable words, const char* needed);
    std::optional<std::uint64_t> whole(const char* name, const WholeRange& range);
    std::optional<double> one_number(const Json& node, const std::string& pointer, const Range& range);
    template <std::size_t N>
    std::optional<std::array<double, N>> numbers(const char* name, const Range& range)
    {
        std::array<double, N> values{};
        if (!read_numbers(name, range, values.data(), N)) return std::nullopt;
        return values;
    }
    bool read_numbers(const char* name, const Range& range, double* values, std::size_t count);
    const Word* word_at(std::string pointer, const std::string& text, WordTable words);
    const std::string* text(const char* name, std::size_t longest);
    const std::string*
    text_at(const Json& node, const std::string& pointer, std::size_t shortest, std::size_t longest);
    bool name_fits(const std::string& pointer, const std::string& name);

    // False where the member is no object, so that it is a value or nothing.
    bool texture(const char* name, std::optional<renderer::TextureUse>& use);
    void file(const std::string& name, const Json& value, std::map<std::string, std::string>& files);
    void mesh_of(renderer::MeshShape& shape);
    std::string digest_for(const std::string& name, const std::string& pointer);
    void digest_check(const std::string& digest, const std::string& pointer);
    void matrix_of(renderer::Affine3& world_from_object);
    void transform_of(renderer::Affine3& world_from_object);
    std::optional<renderer::Affine3> transform_step();
    std::optional<renderer::Vec3d> scale_factors();

    const Json* node_; // null: not an object
    std::string pointer_;
    ReadState& state_;
    std::vector<const char*> known_;
    std::vector<std::string> suggested_; // known ones that are built
    bool forgiving_ = false;             // unknown members are not judged: what the object is, is unclear
};

} // namespace api
