"""The power series of an attitude from that of the rates, q' = q (w, 0) / 2: what the routes by series share."""


def append_row(Q, W, n, cauchy):
    """Append the coefficients n + 1 of a quaternion (x, y, z, w); cauchy(a, b, n) is sum_j a_j b_(n-j)."""
    x, y, z, s = Q
    new = [cauchy(s, W[0], n) + cauchy(y, W[2], n) - cauchy(z, W[1], n),
           cauchy(s, W[1], n) + cauchy(z, W[0], n) - cauchy(x, W[2], n),
           cauchy(s, W[2], n) + cauchy(x, W[1], n) - cauchy(y, W[0], n),
           -cauchy(x, W[0], n) - cauchy(y, W[1], n) - cauchy(z, W[2], n)]
    for k in range(4):
        Q[k].append(new[k] / (2 * (n + 1)))
