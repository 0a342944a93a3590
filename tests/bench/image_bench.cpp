// Time to decode and encode one image, for each layout and byte order (argument: 9, 10 or 11, then 0 little, 1 big).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>

#include "transports/image/codec.hpp"

namespace {

using namespace meca::image;

Format format_of(const benchmark::State& state) {
  return {static_cast<Layout>(state.range(0) - 9), state.range(1) != 0 ? std::endian::big : std::endian::little};
}

template <class Bytes>
Bytes random_bytes() {
  std::mt19937 random(500);
  Bytes bytes;
  std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random()); });
  return bytes;
}

void decode_inputs_bench(benchmark::State& state) {
  auto bytes = random_bytes<InputBytes>();
  const auto format = format_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(bytes);
    auto inputs = decode_inputs(bytes, format);
    benchmark::DoNotOptimize(inputs);
  }
}

void encode_inputs_bench(benchmark::State& state) {
  auto bytes = random_bytes<InputBytes>();
  const auto format = format_of(state);
  auto inputs = decode_inputs(bytes, format);
  for (auto _ : state) {
    benchmark::DoNotOptimize(inputs);
    encode_inputs(inputs, format, bytes);
    benchmark::DoNotOptimize(bytes);
  }
}

void decode_outputs_bench(benchmark::State& state) {
  auto bytes = random_bytes<OutputBytes>();
  const auto format = format_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(bytes);
    auto outputs = decode_outputs(bytes, format);
    benchmark::DoNotOptimize(outputs);
  }
}

void encode_outputs_bench(benchmark::State& state) {
  auto bytes = random_bytes<OutputBytes>();
  const auto format = format_of(state);
  auto outputs = decode_outputs(bytes, format);
  for (auto _ : state) {
    benchmark::DoNotOptimize(outputs);
    encode_outputs(outputs, format, bytes);
    benchmark::DoNotOptimize(bytes);
  }
}

void every_format(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"firmware", "big"})->ArgsProduct({{9, 10, 11}, {0, 1}});
}

BENCHMARK(decode_inputs_bench)->Name("decode_inputs")->Apply(every_format);
BENCHMARK(encode_inputs_bench)->Name("encode_inputs")->Apply(every_format);
BENCHMARK(decode_outputs_bench)->Name("decode_outputs")->Apply(every_format);
BENCHMARK(encode_outputs_bench)->Name("encode_outputs")->Apply(every_format);

}  // namespace

BENCHMARK_MAIN();
