# Recomputes the tables in results/ from the tidy tables of this export, and reports differences.
#
#   Rscript analysis/analyse.R
#
# The script needs R without packages, and is independent of the program that made the export: the tests are R's, sums of
# squares are those of its linear models. The computed tables are written to analysis/r/. Change the script as you like: it
# is a start for your own analysis.

relative <- 1e-6
absolute <- 1e-9 # Figures this small differ by rounding.
confidence <- 0.95
constant_squares <- 1e-20 # Squares this small, of values about 0, are rounding.
equal_within <- 1e-9 # Values that differ by at most this share of the largest input are equal up to rounding.
eta_confidence <- 0.9 # The confidence for a share of the variance, which is one-sided.
largest_f <- 700 # F times its degrees of freedom beyond which the export has no interval,
largest_lambda <- 1400 # nor where an end of it lies beyond this noncentrality.
largest_t <- 18.5 # The limit of t,
largest_delta <- 37 # and of its noncentrality.
exact_below <- 50 # From this many pairs (values in a cohort) on, or with ties or zeros, Wilcoxon's tests are approximated.

script <- sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)[1])
root <- dirname(dirname(normalizePath(script)))

# Everything as text: an id may look like a number. An empty field is no value.
read <- function(name) {
  read.csv(file.path(root, name), colClasses = "character", na.strings = character(), check.names = FALSE,
    encoding = "UTF-8", fileEncoding = "UTF-8")
}

# Names of a row whose value is NA or missing are columns without a value.
mean_interval <- function(values, side) {
  low <- high <- NA
  if (length(values) > 1) {
    half <- qt((1 + confidence) / 2, length(values) - 1) * sd(values) / sqrt(length(values))
    low <- mean(values) - half
    high <- mean(values) + half
  }
  setNames(list(mean(values), low, high), paste0(c("mean_", "low_", "high_"), side))
}

# The noncentralities of t under which one as far out is not surprising, times `unit`; NA: out of reach.
effect_interval <- function(t, df, unit, name) {
  ends <- c(NA, NA)
  below <- function(delta) suppressWarnings(pt(t, df, delta))
  tails <- c(1 + confidence, 1 - confidence) / 2
  if (abs(t) <= largest_t && below(-largest_delta) > tails[1] && below(largest_delta) < tails[2]) {
    at <- function(share) {
      uniroot(function(delta) below(delta) - share, c(-1, 1) * largest_delta, tol = 1e-13, maxiter = 10000)$root
    }
    ends <- c(at(tails[1]), at(tails[2])) * unit
  }
  setNames(as.list(ends), paste0(c("low_", "high_"), name))
}

# Fisher's z with the standard error where nothing differs; none where all ranks are on one side.
biserial <- function(r, error) {
  ends <- if (abs(r) == 1) c(NA, NA) else tanh(atanh(r) + c(-1, 1) * qnorm((1 + confidence) / 2) * error)
  list(rank_biserial = r, low_rank_biserial = ends[1], high_rank_biserial = ends[2])
}

# How far apart the same figure may come out that is computed from these values.
rounding_of <- function(values) equal_within * max(abs(values))

# Which of the values each is, 1 the smallest: those that are equal but for rounding are one, which ties depend on. (R's own digits.rank is
# there from R 4.1 on, and not for all tests.)
levels_of <- function(values, rounding = rounding_of(values)) {
  in_order <- order(values)
  found <- integer(length(values))
  found[in_order] <- cumsum(c(TRUE, diff(values[in_order]) > rounding))
  found
}

paired_t <- function(first, second) {
  d <- first - second
  row <- list(difference = mean(d), df = length(d) - 1)
  if (length(d) < 2 || sd(d) / sqrt(length(d)) <= rounding_of(c(first, second))) return(row)
  test <- t.test(first, second, paired = TRUE, conf.level = confidence)
  t <- unname(test$statistic)
  c(row, list(low_difference = test$conf.int[1], high_difference = test$conf.int[2], t = t, p = test$p.value,
    dz = mean(d) / sd(d)), effect_interval(t, length(d) - 1, 1 / sqrt(length(d)), "dz"))
}

signed_rank <- function(first, second) {
  d <- first - second
  rounding <- rounding_of(c(first, second))
  kept <- d[abs(d) > rounding]
  if (length(kept) == 0) return(list(v = 0, method_wilcoxon = "exact"))
  amounts <- levels_of(abs(kept), rounding)
  exact <- length(kept) == length(d) && !any(duplicated(amounts)) && length(kept) < exact_below
  test <- suppressWarnings(wilcox.test(sign(kept) * amounts, exact = exact, correct = TRUE))
  v <- unname(test$statistic)
  n <- length(kept)
  total <- n * (n + 1) / 2
  c(list(v = v, p_wilcoxon = test$p.value, method_wilcoxon = if (exact) "exact" else "normal"),
    biserial((2 * v - total) / total, sqrt(n * (n + 1) * (2 * n + 1) / 6) / total))
}

welch_t <- function(first, second) {
  n <- c(length(first), length(second))
  row <- list(difference = mean(first) - mean(second))
  if (any(n < 2)) return(row)
  error <- sqrt(var(first) / n[1] + var(second) / n[2])
  if (error <= rounding_of(c(first, second))) return(row)
  test <- t.test(first, second, conf.level = confidence)
  df <- sum(n) - 2
  ds <- row$difference / sqrt(((n[1] - 1) * var(first) + (n[2] - 1) * var(second)) / df)
  unit <- sqrt(sum(1 / n))
  c(row, list(low_difference = test$conf.int[1], high_difference = test$conf.int[2], t = unname(test$statistic),
    df = unname(test$parameter), p = test$p.value, ds = ds), effect_interval(ds / unit, df, unit, "ds"))
}

rank_sum <- function(first, second) {
  n <- c(length(first), length(second))
  levels <- levels_of(c(first, second))
  exact <- !any(duplicated(levels)) && all(n < exact_below)
  of_first <- seq_along(first)
  test <- suppressWarnings(wilcox.test(levels[of_first], levels[-of_first], exact = exact, correct = TRUE))
  w <- unname(test$statistic)
  # With nothing but ties there is no p.
  p <- if (is.nan(test$p.value)) NA else test$p.value
  c(list(w = w, p_rank_sum = p, method_rank_sum = if (exact) "exact" else "normal"),
    biserial(2 * w / prod(n) - 1, sqrt((sum(n) + 1) / (3 * prod(n)))))
}

# A test without a p has none, and counts in the family.
holm <- function(p) if (length(p) == 0) p else p.adjust(p, "holm", n = length(p))

number_of <- function(row, name) if (is.null(row[[name]])) NA_real_ else as.numeric(row[[name]])

# What was asked with a number, in the order first met: its place, and its name (the id where that is of one place alone).
places_of <- function(rows, value) {
  answered <- rows[rows[[value]] != "", ]
  places <- unique(answered[, c("task", "questionnaire", "id")])
  times <- table(places$id)
  places$of <- ifelse(times[places$id] == 1, places$id, paste(places$task, places$questionnaire, places$id, sep = "/"))
  places
}

of_place <- function(rows, place) {
  rows[rows$task == place$task & rows$questionnaire == place$questionnaire & rows$id == place$id, ]
}

# A measure: the mean of what counts, of each (who) under each condition, a matrix with NA where there is none; who is in which cohort.
measure <- function(rows, value, conditions, cohort_of, said) {
  everyone <- sort(unique(rows$who))
  counted <- rows[rows$excluded == "" & rows[[value]] != "", ]
  who <- factor(counted$who, everyone)
  means <- tapply(as.numeric(counted[[value]]), list(who, factor(counted$condition, conditions)), mean)
  cohort <- unname(cohort_of[rows$participant[match(everyone, rows$who)]])
  c(said, list(means = means, cohort = cohort))
}

# What every row of results begins with.
begun <- function(one) {
  list(of = one$of, about = one$about, unit = one$unit, planned = if (one$planned) "TRUE" else "FALSE")
}

# Holm's correction over rows that are tested together: of `p`, and of a second one by ranks.
family <- function(rows, ranks) {
  adjusted <- holm(vapply(rows, number_of, 0, "p"))
  by_ranks <- holm(vapply(rows, number_of, 0, ranks))
  Map(function(row, p, v) c(row, setNames(list(p, v), c("p_holm", paste0(ranks, "_holm")))), rows, adjusted, by_ranks)
}

# One family: each of the measures under two conditions, first - second.
compared <- function(measures, first, second) {
  rows <- lapply(measures, function(one) {
    a <- one$means[, first]
    b <- one$means[, second]
    both <- !is.na(a) & !is.na(b)
    a <- unname(a[both])
    b <- unname(b[both])
    row <- c(begun(one), list(first = first, second = second, n = sum(both)))
    if (!any(both)) return(row)
    c(row, mean_interval(a, "first"), mean_interval(b, "second"), paired_t(a, b), signed_rank(a, b))
  })
  family(rows, "p_wilcoxon")
}

# One family: each of the measures in two cohorts, first - second, by the mean of what each had under all of these conditions.
between <- function(measures, first, second, conditions) {
  rows <- lapply(measures, function(one) {
    # NA where a condition is missing.
    values <- apply(one$means[, conditions, drop = FALSE], 1, mean)
    of <- function(cohort) unname(values[!is.na(values) & one$cohort == cohort])
    a <- of(first)
    b <- of(second)
    row <- c(begun(one), list(first = first, second = second, condition = if (length(conditions) == 1) conditions else "",
      n_first = length(a), n_second = length(b)))
    if (length(a) > 0) row <- c(row, mean_interval(a, "first"))
    if (length(b) > 0) row <- c(row, mean_interval(b, "second"))
    if (length(a) == 0 || length(b) == 0) return(row)
    c(row, welch_t(a, b), rank_sum(a, b))
  })
  family(rows, "p_rank_sum")
}

effect <- function(squares, error, df, epsilon, scale) {
  row <- list(df1 = df[1], df2 = df[2])
  if (df[2] < 1 || error <= constant_squares * scale) return(row)
  f <- squares / df[1] / (error / df[2])
  row <- c(row, list(f = f, p = pf(f, df[1], df[2], lower.tail = FALSE), partial_eta_squared = squares / (squares + error)))
  if (!is.na(epsilon)) {
    corrected <- pf(f, epsilon * df[1], epsilon * df[2], lower.tail = FALSE)
    row <- c(row, list(epsilon = epsilon, p_corrected = corrected))
  }
  if (f * df[1] > largest_f) return(row)
  if (pf(f, df[1], df[2], largest_lambda) > (1 - eta_confidence) / 2) return(row)
  share_at <- function(share) {
    if (pf(f, df[1], df[2]) <= share) return(0)
    below <- function(ncp) pf(f, df[1], df[2], ncp) - share
    ncp <- uniroot(below, c(0, largest_lambda), tol = 1e-13, maxiter = 10000)$root
    ncp / (ncp + sum(df) + 1)
  }
  c(row, list(low_eta = share_at((1 + eta_confidence) / 2), high_eta = share_at((1 - eta_confidence) / 2)))
}

# Effects of conditions, cohorts and both, type III: differences of linear models with sum-coded cohorts, contrast by contrast.
variance_analysis <- function(values, cohort) {
  k <- ncol(values)
  n <- nrow(values)
  groups <- nlevels(cohort)
  scale <- sum(values^2)
  coded <- if (groups > 1) model.matrix(~cohort, contrasts.arg = list(cohort = "contr.sum"))[, -1, drop = FALSE]
  parts <- function(y) {
    if (groups < 2) {
      full <- deviance(lm(y ~ 1))
      return(c(mean = sum(y^2) - full, between = 0, error = full))
    }
    full <- deviance(lm(y ~ coded))
    c(mean = deviance(lm(y ~ 0 + coded)) - full, between = deviance(lm(y ~ 1)) - full, error = full)
  }
  effects <- list()
  if (k > 1) {
    helmert <- contr.helmert(k)
    contrasts <- values %*% sweep(helmert, 2, sqrt(colSums(helmert^2)), "/")
    sums <- rowSums(apply(contrasts, 2, parts))
    epsilon <- NA
    if (sums[["error"]] > constant_squares * scale) {
      residuals <- residuals(if (groups > 1) lm(contrasts ~ cohort) else lm(contrasts ~ 1))
      covariance <- crossprod(residuals)
      epsilon <- sum(diag(covariance))^2 / ((k - 1) * sum(covariance^2))
    }
    effects$conditions <- effect(sums[["mean"]], sums[["error"]], c(k - 1, (n - groups) * (k - 1)), epsilon, scale)
  }
  if (groups > 1) {
    main <- parts(rowSums(values) / sqrt(k))
    effects$cohorts <- effect(main[["between"]], main[["error"]], c(groups - 1, n - groups), NA, scale)
    if (k > 1) {
      df <- c((groups - 1) * (k - 1), (n - groups) * (k - 1))
      effects[["conditions and cohorts"]] <- effect(sums[["between"]], sums[["error"]], df, epsilon, scale)
    }
  }
  effects
}

# Friedman's test of the conditions; with one condition, Kruskal and Wallis's of the cohorts.
rank_test <- function(values, cohort) {
  k <- ncol(values)
  df <- (if (k > 1) k else nlevels(cohort)) - 1
  values[] <- levels_of(values)
  # With nothing but ties there is nothing to rank.
  spread <- if (k > 1) any(apply(values, 1, function(row) length(unique(row)) > 1)) else length(unique(c(values))) > 1
  if (!spread) return(list(df_ranks = df))
  test <- if (k > 1) friedman.test(values) else kruskal.test(c(values), cohort)
  chi <- unname(test$statistic)
  size <- if (k > 1) chi / (nrow(values) * df) else chi / (nrow(values) - 1)
  list(chi_squared = chi, df_ranks = df, p_ranks = test$p.value, effect_ranks = size)
}

# All conditions and cohorts at once, an effect a row; one family.
overall <- function(measures, conditions) {
  found <- lapply(measures, function(measure) {
    complete <- rowSums(is.na(measure$means)) == 0
    cohort <- factor(measure$cohort)
    one <- list(begun = begun(measure), n = sum(complete), effects = list(), ranks = list())
    if (length(complete) == 0 || any(table(cohort[complete]) == 0)) return(one)
    values <- unname(measure$means[complete, , drop = FALSE])
    one$effects <- variance_analysis(values, cohort[complete])
    if (length(conditions) > 1 || nlevels(cohort) > 1) one$ranks <- rank_test(values, cohort[complete])
    one
  })
  tested <- function(one) {
    main <- if (is.null(one$effects$conditions)) one$effects$cohorts else one$effects$conditions
    p <- number_of(main, "p_corrected")
    if (is.na(p)) number_of(main, "p") else p
  }
  adjusted <- holm(vapply(found, tested, 0))
  ranks_adjusted <- holm(vapply(found, function(one) number_of(one$ranks, "p_ranks"), 0))
  table <- list()
  for (index in seq_along(found)) {
    one <- found[[index]]
    for (label in names(one$effects)) {
      first <- if (label == names(one$effects)[1]) {
        c(one$ranks, list(p_holm = adjusted[index], p_ranks_holm = ranks_adjusted[index]))
      }
      table <- c(table, list(c(one$begun, list(effect = label, n = one$n), one$effects[[label]], first)))
    }
  }
  table
}

# Work of the page per frame, over all trials of a task under a condition in a cohort.
frame_times <- function(rows, trials, cohort_of) {
  trial_of <- function(of) paste(of$participant, of$task, of$block, of$run, of$attempt, of$repetition, of$condition)
  rows$missed <- trials$missed_frames[match(trial_of(rows), trial_of(trials))]
  rows$cohort <- unname(cohort_of[rows$participant])
  rows <- rows[rows$excluded == "", ]
  key <- c("task", "condition", "cohort", "stage")
  groups <- unique(rows[, key])
  groups <- groups[order(groups$stage != "frame"), ]
  lapply(seq_len(nrow(groups)), function(index) {
    group <- groups[index, ]
    own <- merge(rows, group, by = key)
    counts <- as.numeric(own$count)
    list(task = group$task, condition = group$condition, cohort = group$cohort, stage = group$stage, trials = nrow(own),
      frames = sum(counts), min = min(as.numeric(own$min)), max = max(as.numeric(own$max)), mean = sum(counts * as.numeric(own$mean)) / sum(counts),
      worst_p95 = max(as.numeric(own$p95)), missed = sum(as.numeric(own$missed)))
  })
}

# What was answered, or the scales computed from it, as measures.
answer_measures <- function(file, id, value, words, context) {
  rows <- read(file)
  rows$id <- rows[[id]]
  rows$who <- rows$participant
  places <- places_of(rows, value)
  lapply(seq_len(nrow(places)), function(index) {
    place <- places[index, ]
    name <- paste(place$task, place$questionnaire, place$id, sep = "/")
    said <- list(of = place$of, unit = "answer", about = unname(words[paste(place$questionnaire, place$id)]),
      planned = name %in% context$planned)
    measure(of_place(rows, place), value, context$conditions, context$cohort_of, said)
  })
}

# The scores of every task, in points or per cent. The members of a group report one and the same score.
score_measures <- function(trials, unit, context) {
  # Practice has no condition.
  trials <- trials[trials$condition != "", ]
  trials$who <- as.numeric(trials$group)
  again <- duplicated(trials[, c("task", "group", "condition", "repetition", "excluded")], fromLast = TRUE)
  once <- trials[!again | trials$excluded != "", ]
  lapply(unique(trials$task), function(task) {
    said <- list(of = task, unit = unit, about = "", planned = unit == "points" && paste0(task, "/score") %in% context$planned)
    value <- if (unit == "points") "score" else "percent"
    measure(once[once$task == task, ], value, context$conditions, context$cohort_of, said)
  })
}

# Every two, the later one of the plan first: what comes first in it is what others are compared with.
pairs_of <- function(ids) {
  if (length(ids) < 2) return(list())
  lapply(combn(ids, 2, simplify = FALSE), rev)
}

all_tables <- function() {
  said <- read("conditions.csv")
  conditions <- said$id[said$compared == "condition"]
  cohorts <- said$id[said$compared == "cohort"]
  people <- read("participants.csv")
  context <- list(conditions = conditions, planned = read("planned.csv")$measure,
    cohort_of = setNames(people$cohort, people$participant))
  about <- read("questions.csv")
  about <- setNames(about$about, paste(about$questionnaire, about$question))
  labels <- read("scale-definitions.csv")
  labels <- setNames(labels$label, paste(labels$questionnaire, labels$scale))
  trials <- read("trials.csv")
  answers <- answer_measures("answers.csv", "question", "answer", about, context)
  scales <- answer_measures("scales.csv", "scale", "value", labels, context)
  points <- score_measures(trials, "points", context)
  percent <- score_measures(trials, "percent", context)
  all <- c(answers, scales, points)
  planned <- all[vapply(all, function(one) one$planned, NA)]
  # By the mean of all conditions, and by each of several alone.
  views <- if (length(conditions) > 1) c(list(conditions), as.list(conditions)) else list(conditions)
  kinds <- list(planned = list(planned), answers = list(answers), scales = list(scales), scores = list(points, percent))
  tables <- list()
  for (name in names(kinds)) {
    families <- kinds[[name]]
    tables[[paste0(name, "-compared")]] <- do.call(c, as.list(unlist(lapply(pairs_of(conditions), function(pair) {
      lapply(families, compared, pair[1], pair[2])
    }), recursive = FALSE)))
    whole <- length(conditions) > 2 || length(cohorts) > 0
    tables[[paste0(name, "-overall")]] <- if (whole) overall(families[[1]], conditions) else list()
    tables[[paste0(name, "-cohorts")]] <- do.call(c, as.list(unlist(lapply(pairs_of(cohorts), function(pair) {
      unlist(lapply(views, function(view) lapply(families, between, pair[1], pair[2], view)), recursive = FALSE)
    }), recursive = FALSE)))
  }
  tables[["frame-times"]] <- frame_times(read("frame-times.csv"), trials, context$cohort_of)
  tables
}

# As the table has it: 17 digits give every number back.
as_text <- function(value) {
  if (is.null(value) || length(value) == 0 || is.na(value)) "" else if (is.numeric(value)) sprintf("%.17g", value) else value
}

# Why a cell of the export is not what was computed; NULL: it is.
difference <- function(ours, theirs) {
  said <- as_text(ours)
  if (said == theirs) return(NULL)
  if (is.numeric(ours) && said != "" && theirs != "") {
    if (abs(ours - as.numeric(theirs)) <= relative * abs(as.numeric(theirs)) + absolute) return(NULL)
  }
  sprintf('"%s" in the export, "%s" here', theirs, said)
}

out <- file.path(root, "analysis", "r")
dir.create(out, showWarnings = FALSE)
wrong <- 0
tables <- all_tables()
kinds <- c("planned", "answers", "scales", "scores")
for (name in c(t(outer(kinds, c("-compared", "-overall", "-cohorts"), paste0)), "frame-times")) {
  table <- tables[[name]]
  theirs <- read(sprintf("results/%s.csv", name))
  columns <- setdiff(names(theirs), "simulated")
  cells <- do.call(rbind, lapply(table, function(row) vapply(columns, function(column) as_text(row[[column]]), "")))
  cells <- if (is.null(cells)) matrix("", 0, length(columns), dimnames = list(NULL, columns)) else cells
  write.csv(cells, file.path(out, paste0(name, ".csv")), row.names = FALSE, fileEncoding = "UTF-8")
  complaints <- character()
  if (nrow(theirs) != length(table)) complaints <- sprintf("%d rows in the export, %d here", nrow(theirs), length(table))
  for (number in seq_len(min(nrow(theirs), length(table)))) {
    for (column in columns) {
      # Text of a formula's look has an apostrophe of the export's before it.
      said <- difference(table[[number]][[column]], sub("^'", "", theirs[[column]][number]))
      if (!is.null(said)) complaints <- c(complaints, sprintf("line %d, %s: %s", number + 1, column, said))
    }
  }
  wrong <- wrong + length(complaints)
  verdict <- if (length(complaints) == 0) "as computed here" else sprintf("%d differences", length(complaints))
  cat(sprintf("results/%s.csv: %d rows, %s\n", name, nrow(theirs), verdict))
  cat(sprintf("  %s\n", head(complaints, 20)), sep = "")
}
quit(status = if (wrong > 0) 1 else 0)
