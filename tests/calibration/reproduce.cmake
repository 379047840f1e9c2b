# Fits the model again and compares it with src/match/verdict_model.hpp, byte for byte.
execute_process(COMMAND ${PYTHON} ${SOURCE}/calibration/fit.py ${SOURCE}/calibration/fit.tsv
                OUTPUT_FILE ${OUTPUT} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "calibration/fit.py ended with exit code ${failed}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${OUTPUT} ${SOURCE}/src/match/verdict_model.hpp
                RESULT_VARIABLE differs)
if(differs)
  message(FATAL_ERROR "src/match/verdict_model.hpp is not what calibration/fit.py makes of calibration/fit.tsv: ${OUTPUT}")
endif()
