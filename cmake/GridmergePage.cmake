# The report page: esbuild bundles web/src/main.ts, web/assemble.py puts page, style and script into one, as C++ source.
# Sets GRIDMERGE_PAGE_SOURCE, for a target of the including folder. A release's sources have it ready.
set(GRIDMERGE_PAGE_SOURCE ${PROJECT_SOURCE_DIR}/web/bundled/page_template.cpp)
if(EXISTS ${GRIDMERGE_PAGE_SOURCE})
  return()
endif()
find_program(GRIDMERGE_ESBUILD esbuild HINTS ${PROJECT_SOURCE_DIR}/web/node_modules/.bin
             DOC "Bundles the report page (Debian package: esbuild)" REQUIRED)

set(web ${PROJECT_SOURCE_DIR}/web)
set(bundle ${PROJECT_BINARY_DIR}/web/main.js)
set(GRIDMERGE_PAGE_SOURCE ${PROJECT_BINARY_DIR}/web/page_template.cpp)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/web)
file(GLOB_RECURSE page_scripts CONFIGURE_DEPENDS ${web}/src/*.ts)
add_custom_command(
  OUTPUT ${bundle}
  COMMAND ${GRIDMERGE_ESBUILD} ${web}/src/main.ts --bundle --minify --format=iife --target=es2020 --charset=utf8
          --log-level=warning --outfile=${bundle}
  DEPENDS ${page_scripts}
  COMMENT "Bundling the report page's script"
  VERBATIM)
add_custom_command(
  OUTPUT ${GRIDMERGE_PAGE_SOURCE}
  COMMAND Python3::Interpreter ${web}/assemble.py --template ${web}/page.html --style ${web}/src/style.css
          --script ${bundle} --output ${GRIDMERGE_PAGE_SOURCE}
  DEPENDS ${web}/assemble.py ${web}/page.html ${web}/src/style.css ${bundle}
  COMMENT "Assembling the report page"
  VERBATIM)
