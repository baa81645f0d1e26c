# Two commands: `make demo` and `make test`. Each installs what is missing on Debian 12, builds and runs.
# `make test PRESET=ci` treats warnings as errors. JOBS limits the parallel jobs.

PRESET ?= release
JOBS ?= $(shell nproc)
BUILD = build/$(PRESET)

.PHONY: help demo test build lint bench asan tsan fuzz format install clean setup-build setup-test

help:
	@echo "make demo     a simulated flight through the whole method; then open out/demo/report.html"
	@echo "make test     all tests, formatting and lint included"
	@echo "make build    the program: build/release/skyhalo"
	@echo "make lint     formatting, clang-tidy and the layers' order only"
	@echo "make bench    benchmarks"
	@echo "make asan     the tests under the address and undefined-behaviour sanitisers"
	@echo "make tsan     the tests that use threads under the thread sanitiser"
	@echo "make fuzz     short runs of the fuzzers"
	@echo "make format   format all sources"
	@echo "make install  install program, library and headers (PREFIX=/usr/local)"
	@echo "make clean    remove build/ and out/"

setup-build:
	@tools/setup_debian.sh build

setup-test:
	@tools/setup_debian.sh test

# The program alone: no test, example or benchmark is built for somebody who wants to look.
demo: setup-build
	cmake --preset release -DSKYHALO_BUILD_TESTS=OFF -DSKYHALO_BUILD_BENCH=OFF -DSKYHALO_BUILD_EXAMPLES=OFF
	cmake --build --preset release --parallel $(JOBS) --target skyhalo_program
	build/release/skyhalo demo --out out/demo

build: setup-build
	cmake --preset release -DSKYHALO_BUILD_TESTS=OFF -DSKYHALO_BUILD_BENCH=OFF -DSKYHALO_BUILD_EXAMPLES=OFF
	cmake --build --preset release --parallel $(JOBS)

test: setup-test
	cmake --preset $(PRESET) -DSKYHALO_BUILD_TESTS=ON -DSKYHALO_BUILD_BENCH=ON -DSKYHALO_BUILD_EXAMPLES=ON
	cmake --build --preset $(PRESET) --parallel $(JOBS)
	ctest --preset $(PRESET) --parallel $(JOBS)

lint: setup-test
	cmake --preset $(PRESET) -DSKYHALO_BUILD_TESTS=ON -DSKYHALO_BUILD_BENCH=ON -DSKYHALO_BUILD_EXAMPLES=ON
	ctest --test-dir build/$(PRESET) --output-on-failure --label-regex lint

bench: setup-test
	cmake --preset release -DSKYHALO_BUILD_TESTS=ON -DSKYHALO_BUILD_BENCH=ON -DSKYHALO_BUILD_EXAMPLES=ON
	cmake --build --preset release --parallel $(JOBS)
	for layer in rectify sphere map; do build/release/bench/bench_$$layer --benchmark_repetitions=5 --benchmark_report_aggregates_only=true || exit 1; done
	build/release/bench/bench_matcher

asan: setup-test
	cmake --preset asan
	cmake --build --preset asan --parallel $(JOBS)
	ctest --preset asan --parallel $(JOBS)

tsan: setup-test
	cmake --preset tsan
	cmake --build --preset tsan --parallel $(JOBS)
	ctest --preset tsan --parallel $(JOBS)

fuzz: setup-test
	cmake --preset asan
	cmake --build --preset fuzz --parallel $(JOBS)
	ctest --preset fuzz

format: setup-test
	git ls-files '*.cpp' '*.hpp' | xargs clang-format-14 -i

install: build
	cmake --install build/release $(if $(PREFIX),--prefix $(PREFIX))

clean:
	rm -rf build out
