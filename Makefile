# The front door. `make help` lists what it opens.
BUILD ?= build
PREFIX ?= /usr/local

.PHONY: run test deps build lint bench suites pictures gallery install clean help
.DEFAULT_GOAL := help

run: deps ## build, then show scenes/valley.json: in a window, or as out/valley.png
	@scripts/build.sh $(BUILD)
	@scripts/run.sh $(BUILD)

test: ## every test, on software Vulkan, and with sanitizers by a second compiler
	@scripts/deps.sh test
	@scripts/test.sh $(BUILD)

deps: ## install the Debian packages that are missing
	@scripts/deps.sh

build: ## build release
	@scripts/build.sh $(BUILD)

lint: ## static checks
	@scripts/deps.sh lint
	@scripts/lint.sh $(BUILD)

bench: deps ## measure everything, or one figure with ONLY=NAME (of soak: SECONDS=600)
	@bench/run $(BUILD) $(ONLY) $(SECONDS)

suites: build ## weald bench in full, results and reports in docs/bench (stopped, it goes on)
	@scripts/suites.sh $(BUILD)

pictures: build ## the drawn pictures of README.md and docs (DATA=DIR)
	@scripts/deps.sh docs
	@scripts/pictures.sh $(BUILD)

gallery: build ## the pictures of docs/gallery.md, path-traced ones beside them (DATA=DIR)
	@scripts/deps.sh docs
	@scripts/gallery.sh $(BUILD)

install: build ## install program, library, headers and manual below PREFIX
	@meson configure $(BUILD) -Dprefix="$$(realpath -ms -- '$(PREFIX)')"
	@meson install -C $(BUILD)
	@[ -n "$(DESTDIR)" ] || [ "$$(id -u)" != 0 ] || ldconfig

clean: ## remove everything built and rendered
	rm -rf build build-asan out

help: ## this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-8s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
