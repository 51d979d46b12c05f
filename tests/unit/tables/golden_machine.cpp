// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/tables/golden_machine.h"

#include <sodium.h>

#include <cstring>
#include <memory>

#include "tools/compile/compile.h"
#include "tools/model/machine_reader.h"

namespace vernier::golden {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::upload;
namespace {

constexpr const char* kMachine = R"xml(<machine name="golden">
  <variables>
    <static>
      <k value="0.0001" nominal="0" unit=""/>
      <bl value="0.004" nominal="0" unit="mm"/>
      <cte value="0.0001" nominal="0" unit=""/>
      <tau value="40" nominal="40" unit="s"/>
      <flex value="0.002" nominal="0" unit="mm"/>
      <q value="0.001" nominal="0" unit=""/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600" maxcorrection="0.2" maxslew="0.5"/>
      <Y rotary="false" min="0" max="200" maxcorrection="1" maxslew="2"/>
      <C rotary="true" rollover="true" min="0" max="360" maxcorrection="0.1" maxslew="0.2"/>
    </machineaxes>
    <inputs><T unit="degC" reference="20"/></inputs>
    <comptables>
      <table axis="X"><station loc="0" X="0.01"/><station loc="250" X="-0.02"/><station loc="600" X="0.03"/></table>
      <table axis="C" interpolation="cubic"><station loc="-180" Y="0.004"/><station loc="-60" Y="-0.003"/>
        <station loc="70" Y="0.006"/><station loc="180" Y="0.004"/></table>
    </comptables>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X+lXx+k*X+bl*dirX+flex*sin(C)+flex*max(0,min(1,sinceX/10))" Y="Y+cte*Y*lag(T-20,tau)+lCy" Z="0"/>
    <sixdof n="2" X="q*abs(vX)/1000+q*aX/1000+q*feed/1000+q*curv" Y="q*t/1000+q*sign(vY)*(Y&lt;100)*(dirX=1)+q*visit/10" Z="0"/>
  </transforms>
</machine>)xml";

}  // namespace

std::vector<std::uint8_t> golden_image() {
  const std::string text = kMachine;
  return compile_machine(parse_machine(text, "golden.xml"), text, {}).image;
}

SigningKey golden_key() {
  std::uint8_t seed[crypto_sign_SEEDBYTES], part[crypto_sign_PUBLICKEYBYTES];
  for (std::size_t i = 0; i < sizeof(seed); ++i) seed[i] = static_cast<std::uint8_t>(i);
  SigningKey key{};
  crypto_sign_seed_keypair(part, key.secret.data(), seed);
  return key;
}

AlignedImage::AlignedImage(const std::vector<std::uint8_t>& bytes) : words((bytes.size() + 7) / 8) {
  if (!bytes.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  const auto workspace = std::make_unique<ImageWorkspace>();
  fault = view.open(reinterpret_cast<const std::uint8_t*>(words.data()),
                    static_cast<std::uint32_t>(bytes.size()), *workspace);
}

}  // namespace vernier::golden
