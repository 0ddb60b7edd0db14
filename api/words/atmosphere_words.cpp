// Words of an atmosphere.
#include "api/words/word_table.h"

#include <array>

namespace api {

using renderer::AtmosphereDescription;
using renderer::AtmospherePreset;
using renderer::MiePhase;
using renderer::SkyMode;
using renderer::SkyScattering;

template <>
WordTable words_for<std::variant<AtmosphereDescription>>()
{
    static constexpr std::array words{Word{"atmosphere", 0}};
    return words;
}

template <>
WordTable words_for<AtmospherePreset>()
{
    static constexpr std::array words{enumerator("earth", AtmospherePreset::earth),
                                      enumerator("mars", AtmospherePreset::mars),
                                      enumerator("reference_r", AtmospherePreset::reference_r),
                                      enumerator("reference_s", AtmospherePreset::reference_s),
                                      enumerator("reference_b", AtmospherePreset::reference_b)};
    return words;
}

template <>
WordTable words_for<MiePhase>()
{
    static constexpr std::array words{enumerator("cornette_shanks", MiePhase::cornette_shanks),
                                      enumerator("henyey_greenstein", MiePhase::henyey_greenstein)};
    return words;
}

template <>
WordTable words_for<SkyScattering>()
{
    static constexpr std::array words{enumerator("single", SkyScattering::single),
                                      enumerator("multiple", SkyScattering::multiple)};
    return words;
}

template <>
WordTable words_for<SkyMode>()
{
    static constexpr std::array words{enumerator("auto", SkyMode::automatic),
                                      enumerator("exact", SkyMode::exact),
                                      enumerator("fast", SkyMode::fast)};
    return words;
}

} // namespace api
