#pragma once

// Under these flags a compiler reorders sums, and the double-double arithmetic of the headers loses its low half.
#if (defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)) && !defined(POLHODE_ALLOW_FAST_MATH)
#error "polhode: the results of inline functions are wrong under -ffast-math and -fassociative-math. Compile this file \
without them, or define POLHODE_ALLOW_FAST_MATH if it calls only functions that are compiled into the library."
#endif
